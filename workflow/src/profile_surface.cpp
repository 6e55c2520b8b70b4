// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "profile_edges.h"
#include "surf/afm/step_height.h"
#include "surf/core/error.h"

namespace surf::workflow {
namespace {

using Wall = std::array<Measured, profile_numbers>;

/// A wall's height at a distance from the middle of its flank.
class WallHeight {
 public:
  explicit WallHeight(const Wall& w)
      : profile_(wall_profile({w[profile_height].value, w[profile_angle].value,
                               w[profile_top].value, w[profile_foot].value})),
        top_(w[profile_height].value) {}

  /// Undercut walls: what is seen from above.
  double at(double u) const {
    if (u <= profile_.front().x) return profile_.back().x < u ? top_ : 0;
    double highest = u >= profile_.back().x ? top_ : 0;
    for (std::size_t i = 1; i < profile_.size(); ++i) {
      const Point2 a = profile_[i - 1], b = profile_[i];
      if ((u - a.x) * (u - b.x) > 0 || a.x == b.x) continue;
      highest = std::max(highest, a.y + (b.y - a.y) * (u - a.x) / (b.x - a.x));
    }
    return highest;
  }

 private:
  std::vector<Point2> profile_;
  double top_;
};

/// Heights of a wall whose numbers are moved by their standard errors, one by one.
struct WallDoubt {
  WallHeight middle;
  std::vector<WallHeight> moved;

  explicit WallDoubt(const Wall& wall) : middle(wall) {
    for (const std::size_t k : {profile_height, profile_angle, profile_top, profile_foot}) {
      if (!(wall[k].standard_error > 0)) continue;
      for (const double by : {wall[k].standard_error, -wall[k].standard_error}) {
        Wall other = wall;
        other[k].value += by;
        try {
          moved.emplace_back(other);
          break;
        } catch (const InvalidInput&) {  // no wall has such corners: to the other side
        }
      }
    }
  }

  double deviation(double u, double place_error) const {
    constexpr double step = 0.25;
    const double z = middle.at(u), slope = std::max(std::abs(middle.at(u + step) - z),
                                                    std::abs(z - middle.at(u - step))) /
                                           step;
    double variance = slope * place_error * slope * place_error;
    for (const WallHeight& other : moved) variance += std::pow(other.at(u) - z, 2);
    return std::sqrt(variance);
  }
};

struct At {
  std::size_t edge = 0;
  double u = 0, place_error = 0;
};

/// The row's error of an edge: of its mean, and of how far the row follows.
double place_error(const FittedEdge& e, std::size_t row) {
  const double own = e.errors_nm[row];
  return std::hypot(e.place_nm.standard_error, std::isfinite(own) ? own : 0);
}

/// By fitted features, or by rims, or as told; 0 where features do not repeat.
Measured pitch_of_surface(const PlacedImage& image, const ProfileSummary& s) {
  constexpr double by_rims_px = 0.25;
  if (s.pitch_nm == 0) return {};
  return s.measured_pitch_nm.value_or(Measured{s.pitch_nm, by_rims_px * image.pitch_x_nm});
}

/// The edge that lies nearest to a pixel.
At nearest(const std::vector<FittedEdge>& edges, double x, std::size_t row) {
  At best;
  double least = HUGE_VAL;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double off = x - edges[e].smooth_nm[row];
    if (std::abs(off) >= least) continue;
    least = std::abs(off);
    best = {e, edges[e].edge.material_right ? off : -off, place_error(edges[e], row)};
  }
  return best;
}

/// The fitted mean profile of such walls at a distance from their middle, beyond it as at its ends.
double fitted_at(const std::vector<MeanProfile>& profiles, bool material_right, double u) {
  for (const MeanProfile& p : profiles) {
    if (p.material_right != material_right) continue;
    const auto after = std::ranges::lower_bound(p.u_nm, u);
    if (after == p.u_nm.begin()) return p.fitted.front();
    if (after == p.u_nm.end()) return p.fitted.back();
    const auto i = static_cast<std::size_t>(after - p.u_nm.begin());
    const double share = (u - p.u_nm[i - 1]) / (p.u_nm[i] - p.u_nm[i - 1]);
    return p.fitted[i - 1] + share * (p.fitted[i] - p.fitted[i - 1]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void add_lines(const PlacedImage& image, ProfileSummary& s) {
  s.edge_lines_nm.clear();
  for (const FittedEdge& e : s.fit.edges()) {
    const auto rows = static_cast<double>(e.rows_nm.size());
    std::vector<Point2>& line = s.edge_lines_nm.emplace_back();
    for (std::size_t r = 0; r < e.rows_nm.size(); ++r) {
      if (!s.hole) {
        line.push_back({e.rows_nm[r], image.y_nm(static_cast<double>(r))});
        continue;
      }
      const double a = 2 * std::numbers::pi * (static_cast<double>(r) + 0.5) / rows;
      line.push_back(
          {s.hole->x_nm + e.rows_nm[r] * std::cos(a), s.hole->y_nm + e.rows_nm[r] * std::sin(a)});
    }
    s.row_distance_nm = s.hole ? 2 * std::numbers::pi * s.hole->radius_nm / rows : image.pitch_y_nm;
  }
}

Grid<double> turned(const Grid<double>& grid) {
  Grid<double> out(grid.height(), grid.width());
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) out(y, x) = grid(x, y);
  return out;
}

}  // namespace

void add_surface(const PlacedImage& image, ProfileSummary& s) {
  add_lines(image, s);
  const std::vector<FittedEdge> edges =
      edges_in_sight(image, s.threshold.cut_off, s.fit.edges(), pitch_of_surface(image, s));
  const std::array<WallDoubt, 2> walls{WallDoubt(s.fit.left), WallDoubt(s.fit.right)};
  const int w = image.values.width(), h = image.values.height();
  s.surface = {image.placement(), Grid<double>(w, h)};
  s.deviation_nm = s.fitted = Grid<double>(w, h);
  const auto rows = static_cast<double>(edges.front().smooth_nm.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      double across = image.x_nm(x);
      auto row = static_cast<std::size_t>(y);
      if (s.hole) {
        const double dx = image.x_nm(x) - s.hole->x_nm, dy = image.y_nm(y) - s.hole->y_nm;
        across = std::hypot(dx, dy);
        const double turn = std::atan2(dy, dx) / (2 * std::numbers::pi);
        row = static_cast<std::size_t>(std::clamp((turn - std::floor(turn)) * rows, 0.0, rows - 1));
      }
      const At at = nearest(edges, across, row);
      const bool material_right = edges[at.edge].edge.material_right;
      const WallDoubt& wall = walls[material_right ? 0 : 1];
      s.surface.z_nm(x, y) = wall.middle.at(at.u);
      s.deviation_nm(x, y) = wall.deviation(at.u, at.place_error);
      s.fitted(x, y) = fitted_at(s.fit.sights.front().profiles, material_right, at.u);
    }
}

void turn_surface(ProfileSummary& s) {
  std::swap(s.surface.origin_x_nm, s.surface.origin_y_nm);
  std::swap(s.surface.pitch_x_nm, s.surface.pitch_y_nm);
  for (Grid<double>* grid : {&s.surface.z_nm, &s.deviation_nm, &s.fitted}) *grid = turned(*grid);
  for (std::vector<Point2>& line : s.edge_lines_nm)
    for (Point2& place : line) std::swap(place.x, place.y);
}

Measured wall_height(const HeightField& scan) {
  constexpr int farthest = 2;  // samples, from what is between the levels
  constexpr std::ptrdiff_t fewest = 16;
  constexpr double level_share = 0.15, least_of_level = 1.5;
  std::vector<double> sorted;
  for (std::size_t i = 0; i < scan.z_nm.size(); ++i)
    if (scan.valid.includes(i)) sorted.push_back(scan.z_nm.data()[i]);
  if (sorted.size() < 64)
    throw InvalidInput("AFM scan", "it has hardly any samples", "Give another");
  std::ranges::sort(sorted);
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  const double low = at(0.1), high = at(0.9), band = level_share * (high - low);
  // Between steep sides that meet heights are spread alike; a level has more of them than what is
  // above it.
  const auto between = [&](double from, double to) {
    return static_cast<double>(std::ranges::lower_bound(sorted, to) -
                               std::ranges::lower_bound(sorted, from));
  };
  if (between(low - band, low + band) < least_of_level * between(low + band, low + 3 * band))
    throw InvalidInput("AFM scan",
                       "its lowest places are not level: where the tip does not reach the ground, "
                       "walls are higher than the scan shows",
                       "Say `profile.height` and `profile.height_error`, or give the scan of a "
                       "sharper tip");
  const auto near = [&](double level, int away) {
    Mask mask(scan.z_nm.width(), scan.z_nm.height());
    for (int y = 0; y < mask.height(); ++y)
      for (int x = 0; x < mask.width(); ++x) {
        bool all = true;
        for (int k = -away; k <= away && all; ++k) {
          const int u = std::clamp(x + k, 0, mask.width() - 1),
                    v = std::clamp(y + k, 0, mask.height() - 1);
          all = scan.is_valid(u, y) && std::abs(scan.z_nm(u, y) - level) < band &&
                scan.is_valid(x, v) && std::abs(scan.z_nm(x, v) - level) < band;
        }
        mask(x, y) = all;
      }
    return mask;
  };
  for (int away = farthest; away >= 0; --away) {
    const Mask ground = near(low, away), top = near(high, away);
    if (std::ranges::count(ground.data(), 1) < fewest || std::ranges::count(top.data(), 1) < fewest)
      continue;  // narrow places
    const StepHeight step = measure_step(scan, ground, top);
    return {step.height_nm, step.stderr_nm};
  }
  throw InvalidInput("AFM scan", "it does not show two levels", "Say `profile.height`");
}

}  // namespace surf::workflow
