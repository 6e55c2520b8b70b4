// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/round_tip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

#include "surf/core/error.h"

namespace surf {
namespace {

constexpr int directions = 72;
constexpr double rounding = 1e-9;

/// Interpolates linearly between samples; -infinity next to missing samples.
double height_at(const Tip& t, double u, double v) {
  const int i = std::clamp(static_cast<int>(u), 0, t.z_nm.width() - 1),
            j = std::clamp(static_cast<int>(v), 0, t.z_nm.height() - 1);
  const double a = u - i, b = v - j;
  double z = 0;
  for (const auto& [dx, dy, weight] : {std::tuple{0, 0, (1 - a) * (1 - b)},
                                       {1, 0, a * (1 - b)},
                                       {0, 1, (1 - a) * b},
                                       {1, 1, a * b}})
    if (weight > rounding)  // 0 times -infinity is NaN
      z += weight *
           t.z_nm(std::min(i + dx, t.z_nm.width() - 1), std::min(j + dy, t.z_nm.height() - 1));
  return z;
}

}  // namespace

std::vector<double> round_profile_nm(const Tip& t, double share) {
  validate(t);
  if (!(share >= 0 && share <= 1))
    throw UsageError("share of directions", fmt::format("{} is not in 0 to 1", share),
                     "0.1 is usual");
  const double step = std::min(t.pitch_x_nm, t.pitch_y_nm);
  const auto rank = static_cast<std::size_t>(std::lround(share * (directions - 1)));
  const auto inside = [](double at, int samples) {
    return at > -rounding && at < samples - 1 + rounding;
  };
  std::vector<double> profile{0.0};
  for (double radius = step;; radius = step * static_cast<double>(profile.size())) {
    std::vector<double> heights;
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * std::numbers::pi * k / directions;
      const double u = t.apex_x + radius * std::cos(angle) / t.pitch_x_nm,
                   v = t.apex_y + radius * std::sin(angle) / t.pitch_y_nm;
      if (inside(u, t.z_nm.width()) && inside(v, t.z_nm.height()))
        heights.push_back(height_at(t, u, v));
    }
    if (heights.size() <= rank) break;
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(rank),
                     heights.end());
    profile.push_back(heights[rank]);
  }
  return profile;
}

Tip tip_below(const std::vector<std::vector<double>>& profiles, double pitch_x, double pitch_y,
              double depth, int most_samples) {
  if (!(pitch_x > 0 && pitch_y > 0 && depth > 0 && most_samples >= 1))
    throw UsageError("round tip", "pitches, depth and samples must be above 0", "Give the scan's");
  std::vector<double> z{0.0};
  std::size_t told = 1;
  for (const auto& p : profiles) {
    if (p.empty() || p.front() != 0)
      throw UsageError("round tip", "a profile does not begin with 0 at the apex",
                       "Give heights below it");
    told = std::max(told, p.size());
  }
  const auto bound = [&](std::size_t r) {
    double low = 0;
    for (const auto& p : profiles)
      if (r < p.size()) low = std::min(low, p[r]);
    return low;
  };
  const auto beyond = [&] {
    return z.size() > 1 ? 2 * z.back() - z[z.size() - 2] : 0.0;
  };  // at least as steep as before
  while (z.back() > -depth && z.size() <= static_cast<std::size_t>(most_samples) &&
         (z.size() < told || z.back() < 0))
    z.push_back(std::min(bound(z.size()), beyond()));
  const double step = std::min(pitch_x, pitch_y), reach = step * static_cast<double>(z.size() - 1);
  const int half_x = std::max(1, static_cast<int>(std::floor(reach / pitch_x * (1 + rounding))));
  const int half_y = std::max(1, static_cast<int>(std::floor(reach / pitch_y * (1 + rounding))));
  Tip tip{{pitch_x, pitch_y}, Grid<double>(2 * half_x + 1, 2 * half_y + 1), half_x, half_y};
  if (z.size() < 2) z.push_back(0);
  for (int y = -half_y; y <= half_y; ++y)
    for (int x = -half_x; x <= half_x; ++x) {
      const double r = std::hypot(x * pitch_x, y * pitch_y) / step;
      // Corners continue the last slope.
      const std::size_t i = std::min(static_cast<std::size_t>(r), z.size() - 2);
      tip.z_nm(x + half_x, y + half_y) = z[i] + (r - static_cast<double>(i)) * (z[i + 1] - z[i]);
    }
  return tip;
}

}  // namespace surf
