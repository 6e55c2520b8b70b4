// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace surf {

/// The upper median of at least one value. Reorders the values.
inline double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The standard deviation of normal numbers that have this median of absolute deviations from the
/// median. Changes the values.
inline double robust_deviation(std::vector<double>& values) {
  constexpr double normal = 1.482602218505602;
  const double middle = median(values);
  for (double& v : values) v = std::abs(v - middle);
  return normal * median(values);
}

}  // namespace surf
