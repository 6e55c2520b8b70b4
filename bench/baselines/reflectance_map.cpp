// SPDX-License-Identifier: GPL-3.0-or-later
#include "reflectance_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surf::bench {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Derivatives for a monotone cubic. At level ground the derivative is 0 by symmetry.
std::vector<double> monotone_slopes(const std::vector<double>& y, double step) {
  const std::size_t n = y.size();
  std::vector<double> slopes(n, 0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = (y[i] - y[i - 1]) / step, after = (y[i + 1] - y[i]) / step;
    if (before * after > 0) slopes[i] = 2 * before * after / (before + after);
  }
  slopes[n - 1] = (y[n - 1] - y[n - 2]) / step;
  return slopes;
}

}  // namespace

ReflectanceMap::ReflectanceMap(double step_deg, std::vector<double> grey_levels)
    : level_ground_(grey_levels.front()), step_rad_(step_deg * degree),
      levels_(std::move(grey_levels)) {
  for (double& level : levels_) level /= level_ground_;
  slopes_ = monotone_slopes(levels_, step_rad_);
}

ReflectanceMap::Value ReflectanceMap::at(double p, double q) const {
  const double slope = std::hypot(p, q), angle = std::atan(slope), place = angle / step_rad_;
  const std::size_t i = std::min(static_cast<std::size_t>(place), levels_.size() - 2);
  const double t = place - static_cast<double>(i), a = levels_[i], b = levels_[i + 1],
               da = slopes_[i] * step_rad_, db = slopes_[i + 1] * step_rad_;
  double r, by_place;
  if (t > 1) {
    r = b + db * (t - 1);
    by_place = db;
  } else {
    const double c = 3 * (b - a) - 2 * da - db, d = 2 * (a - b) + da + db;
    r = a + t * (da + t * (c + t * d));
    by_place = da + t * (2 * c + 3 * t * d);
  }
  constexpr double level = 1e-12;
  const double per_slope = slope > level ? by_place / step_rad_ / ((1 + slope * slope) * slope) : 0;
  return {r, per_slope * p, per_slope * q};
}

ReflectanceMap reflectance_of(const SlopeModelParameters& slopes, const std::vector<double>& gains,
                              double offset) {
  constexpr double step_deg = 5, last_deg = 85;
  constexpr int side = 17;
  const auto model = make_slope_model({}, slopes);
  std::vector<double> levels;
  HeightField plane{{1, 1, 0, 0}, Grid<double>(side, side)};
  ModelOptions options;
  options.threads = 1;
  options.double_precision = true;
  for (double angle = 0; angle <= last_deg; angle += step_deg) {
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) plane.z_nm(x, y) = x * std::tan(angle * degree);
    const ModelImages yields = model->predict(plane, options);
    double level = offset;
    for (std::size_t c = 0; c < yields.size(); ++c)
      level += gains[c] * yields[c](side / 2, side / 2);
    levels.push_back(level);
  }
  return {step_deg, std::move(levels)};
}

}  // namespace surf::bench
