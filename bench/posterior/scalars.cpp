// SPDX-License-Identifier: GPL-3.0-or-later
#include "scalars.h"

#include <cmath>

namespace surf::bench {
namespace {

using namespace reconstruction;

constexpr int apex_places = 3;  // up to 19 nm from the apex
constexpr double along_nm = 100, step_nm = 5, beyond_wall_nm = 80;

/// The mean height over the line's length at the distance `t_nm` from its axis; its derivatives are
/// added to `by_height`, if given, `factor` times.
double profile(const HeightField& f, const Block& line, double t_nm, double factor,
               Grid<double>* by_height) {
  const double c = std::cos(line.turn_rad), s = std::sin(line.turn_rad);
  double sum = 0;
  int count = 0;
  for (double along = -along_nm; along <= along_nm; along += step_nm, ++count) {
    const double u = (line.middle.x + c * t_nm - s * along - f.origin_x_nm) / f.pitch_x_nm,
                 v = (line.middle.y + s * t_nm + c * along - f.origin_y_nm) / f.pitch_y_nm;
    const int x = std::clamp(static_cast<int>(u), 0, f.z_nm.width() - 2),
              y = std::clamp(static_cast<int>(v), 0, f.z_nm.height() - 2);
    const double a = u - x, b = v - y;
    const double w[4] = {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
    for (int k = 0; k < 4; ++k) {
      sum += w[k] * f.z_nm(x + k % 2, y + k / 2);
      constexpr double share = 1 / (2 * along_nm / step_nm + 1);
      if (by_height) (*by_height)(x + k % 2, y + k / 2) += factor * w[k] * share;
    }
  }
  return sum / count;
}

}  // namespace

Scalar plateau_height(const HeightField& f, const Block& plateau) {
  Scalar out{0, Grid<double>(f.z_nm.width(), f.z_nm.height())};
  double count = 0;
  for (int y = 0; y < f.z_nm.height(); ++y)
    for (int x = 0; x < f.z_nm.width(); ++x) {
      const Point2 p = plateau.within(f.place_nm(x, y));
      if (std::abs(p.x) > 0.5 * plateau.half_u_nm || std::abs(p.y) > 0.5 * plateau.half_v_nm)
        continue;
      out.value += f.z_nm(x, y);
      out.by_height(x, y) = 1;
      count += 1;
    }
  out.value /= count;
  for (double& d : out.by_height.data()) d /= count;
  return out;
}

std::optional<Scalar> line_width(const HeightField& f, const Block& line) {
  Scalar out{0, Grid<double>(f.z_nm.width(), f.z_nm.height())};
  const double level = 0.5 * line.height_nm;
  for (const int side : {-1, 1}) {
    double before = profile(f, line, 0, 0, nullptr), t = 1;
    if (before <= level) return {};
    for (;; ++t) {
      if (t > line.half_u_nm + beyond_wall_nm) return {};
      const double next = profile(f, line, side * t, 0, nullptr);
      if (next <= level) {
        t -= (level - next) / (before - next);
        break;
      }
      before = next;
    }
    const double fall = (profile(f, line, side * (t - 2), 0, nullptr) -
                         profile(f, line, side * (t + 2), 0, nullptr)) /
                        4;
    profile(f, line, side * t, 1 / fall, &out.by_height);
    out.value += t;
  }
  return out;
}

double apex_radius(const TipChange& tip) {
  double sum = 0;
  for (std::size_t k = 0; k < apex_places; ++k) sum -= tip[k * tip_waves] / apex_places;
  return sum;
}

TipChange apex_radius_by_tip() {
  TipChange out{};
  for (std::size_t k = 0; k < apex_places; ++k) out[k * tip_waves] = -1.0 / apex_places;
  return out;
}

std::vector<Step> map_functions(const Objective& o, const Unknowns& at) {
  const SurfaceFrame& f = o.frame;
  const Point2 middle{f.origin_x_nm + 0.5 * (f.width - 1) * f.pitch_nm,
                      f.origin_y_nm + 0.5 * (f.height - 1) * f.pitch_nm};
  const auto parts = [&](int number, double samples) {
    Step step = o.zero();
    step.map[static_cast<std::size_t>(number)] = samples;
    const Affine map = o.moved(at, step).surface_to_afm;
    const AffineParts p = parts_of(map);
    const Point2 there = map(middle);
    return MapChange{p.rotation_rad, p.scale_x, p.scale_y, p.shear, there.x, there.y};
  };
  std::vector<Step> out(affine_numbers, o.zero());
  constexpr double samples = 1e-4;
  for (int k = 0; k < affine_numbers; ++k) {
    const MapChange up = parts(k, samples), down = parts(k, -samples);
    for (std::size_t i = 0; i < affine_numbers; ++i)
      out[i].map[static_cast<std::size_t>(k)] = (up[i] - down[i]) / (2 * samples);
  }
  return out;
}

std::vector<Step> few_functions(const Objective& o, const Unknowns& at) {
  std::vector<Step> out =
      o.fit_map ? map_functions(o, at) : std::vector<Step>(affine_numbers, o.zero());
  out.resize(affine_numbers + 2 + tip_numbers, o.zero());
  for (std::size_t k = 0; k < 2; ++k) out[affine_numbers + k].mixture[k] = 1;
  for (std::size_t k = 0; k < tip_numbers; ++k) out[affine_numbers + 2 + k].tip[k] = 1;
  return out;
}

}  // namespace surf::bench
