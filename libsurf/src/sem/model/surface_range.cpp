// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/surface_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/units.h"

namespace surf {
namespace {

void require_whole(const HeightField& field) {
  validate(field);
  const auto& valid = field.valid.data();
  if (std::find(valid.begin(), valid.end(), 0) != valid.end())
    throw InvalidInput("height field", "it has missing samples", "'semsurf clean' fills them");
}

/// The slope at each sample, degrees.
std::vector<double> slopes_deg(const HeightField& field) {
  const Grid<double>& z = field.z_nm;
  const int w = z.width(), h = z.height();
  std::vector<double> slopes;
  slopes.reserve(z.size());
  for (int y = 0; y < h; ++y) {
    const int below = std::max(y - 1, 0), above = std::min(y + 1, h - 1);
    for (int x = 0; x < w; ++x) {
      const int left = std::max(x - 1, 0), right = std::min(x + 1, w - 1);
      const double zx = (z(right, y) - z(left, y)) / ((right - left) * field.pitch_x_nm);
      const double zy = (z(x, above) - z(x, below)) / ((above - below) * field.pitch_y_nm);
      slopes.push_back(std::atan(std::hypot(zx, zy)) / degrees_to_radians);
    }
  }
  return slopes;
}

std::vector<double> curvatures_per_nm(const HeightField& field) {
  const Grid<double>& z = field.z_nm;
  const double x2 = field.pitch_x_nm * field.pitch_x_nm, y2 = field.pitch_y_nm * field.pitch_y_nm;
  std::vector<double> curvatures{0};
  for (int y = 1; y + 1 < z.height(); ++y)
    for (int x = 1; x + 1 < z.width(); ++x)
      curvatures.push_back(std::max(std::abs(z(x - 1, y) - 2 * z(x, y) + z(x + 1, y)) / x2,
                                    std::abs(z(x, y - 1) - 2 * z(x, y) + z(x, y + 1)) / y2));
  return curvatures;
}

double percentile_99(std::vector<double>& values) {
  const std::size_t at = values.size() * 99 / 100;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::min(at, values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

SurfaceRange surface_range(const HeightField& field) {
  require_whole(field);
  std::vector<double> slopes = slopes_deg(field), curvatures = curvatures_per_nm(field);
  SurfaceRange range;
  range.slope_deg_max = *std::max_element(slopes.begin(), slopes.end());
  range.slope_deg_p99 = percentile_99(slopes);
  range.curvature_max_per_nm = *std::max_element(curvatures.begin(), curvatures.end());
  range.curvature_p99_per_nm = percentile_99(curvatures);
  return range;
}

SurfaceRange united(const SurfaceRange& a, const SurfaceRange& b) {
  return {std::max(a.slope_deg_p99, b.slope_deg_p99), std::max(a.slope_deg_max, b.slope_deg_max),
          std::max(a.curvature_p99_per_nm, b.curvature_p99_per_nm),
          std::max(a.curvature_max_per_nm, b.curvature_max_per_nm)};
}

double share_steeper(const HeightField& field, double slope_deg) {
  require_whole(field);
  const std::vector<double> slopes = slopes_deg(field);
  const auto steeper =
      std::count_if(slopes.begin(), slopes.end(), [&](double s) { return s > slope_deg; });
  return static_cast<double>(steeper) / static_cast<double>(slopes.size());
}

}  // namespace surf
