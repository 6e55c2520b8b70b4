// SPDX-License-Identifier: GPL-3.0-or-later
#include "explained.h"

#include <limits>

#include "surf/core/parallel.h"

namespace surf {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// out = min(out, in + offset) and max.
__attribute__((target_clones("avx512f", "avx2", "default"))) void lower_to(
    float* __restrict out, const float* __restrict in, float offset, int count) {
  for (int i = 0; i < count; ++i) {
    const float v = in[i] + offset;
    out[i] = v < out[i] ? v : out[i];
  }
}
__attribute__((target_clones("avx512f", "avx2", "default"))) void raise_to(
    float* __restrict out, const float* __restrict in, float offset, int count) {
  for (int i = 0; i < count; ++i) {
    const float v = in[i] + offset;
    out[i] = v > out[i] ? v : out[i];
  }
}

}  // namespace

Grid<float> explained_height(const CarvedScan& scan, const CarvedTip& tip, int threads) {
  // The apex may lie outside of the scan by as much as the tip is wide.
  const int w = scan.width() + tip.width - 1, h = scan.height() + tip.height - 1;
  const int left = tip.width - 1 - tip.apex_x, below = tip.height - 1 - tip.apex_y;   // apex at (x - left, y - below)
  Grid<float> apex(w, h, infinity);
  parallel_for(static_cast<std::size_t>(h), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    float* out = &apex(0, y);
    for (int j = 0; j < tip.height; ++j) {
      const int sy = y - below + (j - tip.apex_y);
      if (sy < 0 || sy >= scan.height()) continue;
      for (int i = 0; i < tip.width; ++i) {
        const auto k = static_cast<std::size_t>(j * tip.stride + i);
        if (tip.z[k] == -infinity) continue;
        // Only where the scan is: beyond it everything is allowed.
        const int shift = -left + (i - tip.apex_x);   // scan column of apex column 0
        const int from = shift < 0 ? -shift : 0;
        const int to = scan.width() - shift < w ? scan.width() - shift : w;
        if (to > from)
          lower_to(out + from, scan.top(from + shift, sy), tip.threshold[k] - tip.z[k], to - from);
      }
    }
  });
  Grid<float> out(scan.width(), scan.height(), -infinity);
  parallel_for(static_cast<std::size_t>(scan.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int j = 0; j < tip.height; ++j) {
      const int ay = y - (j - tip.apex_y) + below;
      for (int i = 0; i < tip.width; ++i) {
        const float z = tip.at(i, j);
        if (z == -infinity) continue;
        raise_to(&out(0, y), &apex(-(i - tip.apex_x) + left, ay), z, scan.width());
      }
    }
  });
  return out;
}

}  // namespace surf
