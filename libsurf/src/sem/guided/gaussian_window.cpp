// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaussian_window.h"

#include <algorithm>
#include <cmath>

namespace surf::guided {

GaussianWindow::GaussianWindow(double sigma_px) {
  const int radius = std::max(0, static_cast<int>(3.5 * sigma_px + 0.5));
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    taps_.push_back(sigma_px > 0 ? std::exp(-0.5 * (i / sigma_px) * (i / sigma_px)) : 1.0);
    sum += i == 0 ? taps_.back() : 2 * taps_.back();
  }
  for (double& tap : taps_) tap /= sum;
}

void GaussianWindow::sum(std::vector<double>& plane, int width, int height,
                         std::vector<double>& scratch) const {
  const std::ptrdiff_t w = width;
  // Down the columns: whole rows are added, which the compiler does in vectors.
  scratch.assign(plane.size(), 0.0);
  for (int y = 0; y < height; ++y) {
    double* const to = scratch.data() + y * w;
    const auto add = [&](int row, double tap) {
      const double* const from = plane.data() + row * w;
      for (int x = 0; x < width; ++x) to[x] += tap * from[x];
    };
    add(y, taps_[0]);
    for (int i = 1; i <= radius(); ++i) {
      if (y >= i) add(y - i, taps_[static_cast<std::size_t>(i)]);
      if (y + i < height) add(y + i, taps_[static_cast<std::size_t>(i)]);
    }
  }
  // Along the rows, from a copy with zeros on either side.
  std::vector<double> padded(static_cast<std::size_t>(width + 2 * radius()), 0.0);
  for (int y = 0; y < height; ++y) {
    const double* const from = scratch.data() + y * w;
    std::copy_n(from, width, padded.begin() + radius());
    double* const to = plane.data() + y * w;
    const double* const middle = padded.data() + radius();
    for (int x = 0; x < width; ++x) to[x] = taps_[0] * middle[x];
    for (int i = 1; i <= radius(); ++i) {
      const double tap = taps_[static_cast<std::size_t>(i)];
      for (int x = 0; x < width; ++x) to[x] += tap * (middle[x - i] + middle[x + i]);
    }
  }
}

}  // namespace surf::guided
