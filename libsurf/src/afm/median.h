// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

namespace surf {

/// The median of at least one value: for an even number, the mean of the two middle ones. Reorders
/// the values.
inline double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2) return *middle;
  const double lower = *std::max_element(values.begin(), middle);
  return lower + 0.5 * (*middle - lower);
}

}  // namespace surf
