// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace surf::guided {

/// A rectangle of pixels with what a regression needs, row by row.
struct LocalData {
  int width = 0, height = 0;
  std::vector<double> target;
  std::vector<double> precision;            ///< 1 / variance of the target; 0: does not count
  std::vector<std::vector<double>> guides;  ///< of the same size each

  std::size_t size() const { return target.size(); }
};

/// Columns from x0 to before x1, rows from y0 to before y1.
struct PixelRange {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

/// Estimates of the target's mean at each pixel.
struct LocalFit {
  std::vector<double> value;
  std::vector<double> variance;  ///< that the target's own variance leaves in `value`
  std::vector<double> leverage;  ///< the derivative of `value` by the target of the same pixel
};

/// At each pixel, fits the target as a linear function of guides by weighted least squares, weights
/// being precision times window, and takes the function's value at that pixel. One fit for each set
/// of guides, which are numbers in `data.guides`; the empty set gives the weighted mean. Slopes are
/// held back by a weak prior, so that guides that hardly vary in a window do no harm.
/// Needs guides of variance about 1, at most 15 in a set. Only pixels of `wanted` are estimated;
/// the others, and those with nothing that counts in their window, are 0.
std::vector<LocalFit> fit_locally(const LocalData& data, double sigma_px, const PixelRange& wanted,
                                  std::span<const std::vector<int>> sets, int threads);

}  // namespace surf::guided
