// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/sem/calibration.h"

namespace surf {
namespace {

constexpr double least_signal = 1e-3;  // share of the image's mean absolute signal

/// Replaces a row or column of `n` numbers, `stride` apart, by sums over windows that are cut at
/// the ends.
void window_sums(double* data, std::size_t n, std::size_t stride, std::size_t range,
                 std::vector<double>& line) {
  line.assign(n + 1, 0);  // cumulative
  for (std::size_t i = 0; i < n; ++i) line[i + 1] = line[i] + data[i * stride];
  for (std::size_t i = 0; i < n; ++i)
    data[i * stride] = line[i + std::min(range, n - 1 - i) + 1] - line[i - std::min(range, i)];
}

Grid<double> box_sums(Grid<double> g, int range_x, int range_y) {
  const auto width = static_cast<std::size_t>(g.width()),
             height = static_cast<std::size_t>(g.height());
  std::vector<double> line;
  for (std::size_t y = 0; y < height; ++y)
    window_sums(g.data().data() + y * width, width, 1, static_cast<std::size_t>(range_x), line);
  for (std::size_t x = 0; x < width; ++x)
    window_sums(g.data().data() + x, height, width, static_cast<std::size_t>(range_y), line);
  return g;
}

}  // namespace

SlowGain slow_gain(const Grid<double>& real, const Grid<double>& signal, int range_x_px,
                   int range_y_px, const Mask& used) {
  const int width = real.width(), height = real.height();
  const auto same = [&](const auto& g) { return g.width() == width && g.height() == height; };
  if (real.empty() || !same(signal) || !(used.empty() || same(used)))
    throw InvalidInput("slow gain", "the images differ in size or are empty",
                       "Give images of one size");
  if (range_x_px < 0 || range_y_px < 0)
    throw UsageError("slow gain", "the range is below 0", "Give 0 or above");
  Grid<double> e(width, height), s(width, height), count(width, height);
  double size = 0, pixels = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    if (!used.empty() && !used.data()[i]) continue;
    if (!std::isfinite(real.data()[i]) || !std::isfinite(signal.data()[i])) continue;
    e.data()[i] = real.data()[i], s.data()[i] = signal.data()[i], count.data()[i] = 1;
    size += std::fabs(signal.data()[i]), pixels += 1;
  }
  const double least = pixels > 0 ? least_signal * size / pixels : 0;
  e = box_sums(std::move(e), range_x_px, range_y_px);
  s = box_sums(std::move(s), range_x_px, range_y_px);
  count = box_sums(std::move(count), range_x_px, range_y_px);
  SlowGain out{Grid<double>(width, height, 1), Mask(width, height, 1), 0};
  for (std::size_t i = 0; i < e.size(); ++i) {
    // Compares with half a pixel: sums of ones are exact, and 0 means none.
    if (count.data()[i] > 0.5 && s.data()[i] != 0 &&
        std::fabs(s.data()[i]) >= least * count.data()[i]) {
      out.gain.data()[i] = e.data()[i] / s.data()[i];
    } else {
      out.known.data()[i] = 0;
      ++out.unknown;
    }
  }
  return out;
}

}  // namespace surf
