// SPDX-License-Identifier: GPL-3.0-or-later
#include "residual_report.h"

#include <algorithm>
#include <cmath>

namespace surf::reconstruction {

ResidualReport judge(const Grid<double>& white, const Mask& used) {
  ResidualReport r;
  double sum = 0, squares = 0, along = 0, across = 0;
  std::int64_t pairs_along = 0, pairs_across = 0;
  const auto counts = [&](int x, int y) { return used.includes(x, y); };
  for (int y = 0; y < white.height(); ++y)
    for (int x = 0; x < white.width(); ++x) {
      if (!counts(x, y)) continue;
      ++r.pixels;
      sum += white(x, y);
      squares += white(x, y) * white(x, y);
      if (x > 0 && counts(x - 1, y)) {
        along += white(x, y) * white(x - 1, y);
        ++pairs_along;
      }
      if (y > 0 && counts(x, y - 1)) {
        across += white(x, y) * white(x, y - 1);
        ++pairs_across;
      }
    }
  if (r.pixels < 2) return r;
  const double n = static_cast<double>(r.pixels), variance = squares / n;
  r.mean = sum / n;
  r.deviation = std::sqrt(std::max(squares / n - r.mean * r.mean, 0.0));
  if (variance > 0 && pairs_along > 0)
    r.along = along / static_cast<double>(pairs_along) / variance;
  if (variance > 0 && pairs_across > 0)
    r.across = across / static_cast<double>(pairs_across) / variance;
  // Limits: what chance allows, plus deviations too small to matter.
  const double chance = 5 / std::sqrt(n);
  r.like_noise = std::fabs(r.mean) < 0.1 + chance && r.deviation > 0.8 - chance &&
                 r.deviation < 1.15 + chance && std::fabs(r.along) < 0.1 + chance &&
                 std::fabs(r.across) < 0.1 + chance;
  return r;
}

double share_of(const Grid<double>& discrepancy, const Grid<double>& image, const Mask& used) {
  double n = 0, sum = 0, squares = 0, off = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!used.includes(i)) continue;
    n += 1;
    sum += image.data()[i];
    squares += image.data()[i] * image.data()[i];
    off += discrepancy.data()[i] * discrepancy.data()[i];
  }
  const double variance = n > 0 ? squares / n - sum / n * (sum / n) : 0;
  return variance > 0 ? std::sqrt(off / n / variance) : 0;
}

}  // namespace surf::reconstruction
