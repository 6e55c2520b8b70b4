// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/diffusion_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "sem/model/ring_shares.h"
#include "sem/model/window_model.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int most_bins = 4096;

[[noreturn]] void refuse(const std::string& reason, const char* remedy) {
  throw InvalidInput("diffusion matrix", reason, remedy);
}

void check(const ModelScope& scope, const DiffusionMatrixParameters& p) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  if (!positive(scope.pixel_nm))
    refuse("it has no pixel size", "Give one: facets are as wide as pixels");
  if (!positive(p.ring_nm) || !positive(p.height_step_nm) || !std::isfinite(p.lowest_nm))
    refuse("a step of its table is not above 0 or its lowest height not finite",
           "Make the table again");
  if (p.rings < 1 || p.rings > most_bins || p.heights < 2 || p.heights > most_bins)
    refuse(fmt::format("its table has {} rings of {} heights", p.rings, p.heights),
           "Make the table again");
  const std::size_t bins = static_cast<std::size_t>(p.rings) * static_cast<std::size_t>(p.heights);
  const std::size_t numbers = bins * diffusion_moments;
  for (const DiffusionMatrixChannel& c : p.channels) {
    if (c.moments_per_nm2.size() != numbers)
      refuse(fmt::format("channel '{}' has {} numbers, not {}", c.name, c.moments_per_nm2.size(),
                         numbers),
             "Make the table again");
    if (!std::ranges::all_of(c.moments_per_nm2, [](double d) { return std::isfinite(d); }))
      refuse(fmt::format("channel '{}' has numbers that are not finite", c.name),
             "Make the table again");
  }
  const double reach = p.rings * p.ring_nm / scope.pixel_nm;
  if (reach > most_diffusion_columns)
    refuse(fmt::format("its electrons reach {:.0f} pixels of {:g} nm", reach, scope.pixel_nm),
           "Use pixels that are larger, or another model");
}

/// Moments in Cartesian coordinates: x, y, z, xx, yy, zz, xy, xz, yz.
using Moments = std::array<double, 9>;

/// The outward flux through a facet over a unit of the plane, and its derivatives by the slopes.
WindowTerm flux(const Moments& m, double slope_x, double slope_y) {
  constexpr double even = 3.0 / 16, square = 15.0 / 16;
  const double x = -slope_x, y = -slope_y;  // of the normal with z = 1
  const double area = std::sqrt(x * x + y * y + 1);
  const double along_x = m[3] * x + m[6] * y + m[7], along_y = m[6] * x + m[4] * y + m[8],
               along_z = m[7] * x + m[8] * y + m[5];
  const double q = x * along_x + y * along_y + along_z, trace = m[3] + m[4] + m[5];
  const double by_area = even * trace - square * q / (area * area);
  WindowTerm t;
  t.value = 0.5 * (m[0] * x + m[1] * y + m[2] + even * trace * area + square * q / area);
  t.by_slope_x = -0.5 * (m[0] + by_area * x / area + 2 * square * along_x / area);
  t.by_slope_y = -0.5 * (m[1] + by_area * y / area + 2 * square * along_y / area);
  return t;
}

class Facets {
 public:
  Facets(const ModelScope& scope, const DiffusionMatrixParameters& p)
      : reach_(ring_reach(p.rings, p.ring_nm, scope.pixel_nm)), lowest_(p.lowest_nm),
        step_(p.height_step_nm), heights_(p.heights) {
    for (const DiffusionMatrixChannel& c : p.channels) add(scope, p, c);
  }

  int reach() const { return reach_; }
  std::size_t channels() const { return tables_.size(); }

  WindowTerm term(std::size_t channel, int dx, int dy, double dz_nm, double slope_x,
                  double slope_y) const {
    const double t = (dz_nm - lowest_) / step_;
    if (!(t > -1.5 && t < heights_ + 0.5)) return {};
    // A quadratic B-spline about the nearest height.
    const int middle = static_cast<int>(std::floor(t + 0.5));
    const double u = t - middle;  // -1/2 to 1/2
    const double weight[] = {0.5 * (0.5 - u) * (0.5 - u), 0.75 - u * u,
                             0.5 * (0.5 + u) * (0.5 + u)};
    const double change[] = {u - 0.5, -2 * u, u + 0.5};
    Moments value{}, by_height{};
    const Moments* column =
        tables_[channel].data() + place(dx, dy) * static_cast<std::size_t>(heights_);
    for (int k = 0; k < 3; ++k) {
      const int i = middle + k - 1;
      if (i < 0 || i >= heights_) continue;
      const Moments& m = column[i];
      for (std::size_t j = 0; j < m.size(); ++j)
        value[j] += weight[k] * m[j], by_height[j] += change[k] * m[j];
    }
    WindowTerm out = flux(value, slope_x, slope_y);
    out.by_height = flux(by_height, slope_x, slope_y).value / step_;
    return out;
  }

  WindowSignal signal(std::size_t, double sum) const { return {sum, 1}; }

 private:
  std::size_t place(int dx, int dy) const {
    return static_cast<std::size_t>((dy + reach_) * (2 * reach_ + 1) + dx + reach_);
  }

  void add(const ModelScope& scope, const DiffusionMatrixParameters& p,
           const DiffusionMatrixChannel& channel) {
    const auto across = static_cast<std::size_t>(2 * reach_ + 1),
               heights = static_cast<std::size_t>(heights_);
    std::vector<Moments> table(across * across * heights);
    for (int k = 0; k < p.rings; ++k) {
      const auto points = ring_points(k, p.ring_nm, scope.pixel_nm);
      const double area = std::numbers::pi * (2 * k + 1) * p.ring_nm * p.ring_nm /
                          static_cast<double>(points.size());
      // The six moments are linear in six sums over a column's points.
      struct Sums {
        double one = 0, c = 0, s = 0, cc = 0, ss = 0, cs = 0;
      };
      std::vector<Sums> sums(across * across);
      for (const RingPoint& q : points) {
        Sums& a = sums[place(q.dx, q.dy)];
        a.one += area, a.c += area * q.cosine, a.s += area * q.sine;
        a.cc += area * q.cosine * q.cosine, a.ss += area * q.sine * q.sine,
            a.cs += area * q.cosine * q.sine;
      }
      const double* ring = channel.moments_per_nm2.data() +
                           static_cast<std::size_t>(k) * heights * diffusion_moments;
      for (std::size_t c = 0; c < sums.size(); ++c) {
        const Sums& a = sums[c];
        for (std::size_t i = 0; a.one > 0 && i < heights; ++i) {
          const double* m = ring + i * diffusion_moments;
          const Moments more{m[0] * a.c,
                             m[0] * a.s,
                             m[1] * a.one,
                             m[2] * a.cc + m[3] * a.ss,
                             m[2] * a.ss + m[3] * a.cc,
                             m[4] * a.one,
                             (m[2] - m[3]) * a.cs,
                             m[5] * a.c,
                             m[5] * a.s};
          for (std::size_t j = 0; j < more.size(); ++j) table[c * heights + i][j] += more[j];
        }
      }
    }
    tables_.push_back(std::move(table));
  }

  int reach_;
  double lowest_, step_;
  int heights_;
  // Per channel: [column][height], times the pixel's area.
  std::vector<std::vector<Moments>> tables_;
};

}  // namespace

std::shared_ptr<const ImageModel> make_diffusion_matrix(
    const ModelScope& scope, const DiffusionMatrixParameters& parameters) {
  std::vector<std::string> names;
  for (const DiffusionMatrixChannel& c : parameters.channels) names.push_back(c.name);
  check_channels(names, "diffusion matrix");
  check(scope, parameters);
  return std::make_shared<WindowModel<Facets>>(scope, std::move(names),
                                               std::make_shared<const Facets>(scope, parameters));
}

}  // namespace surf
