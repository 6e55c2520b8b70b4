// SPDX-License-Identifier: GPL-3.0-or-later
#include "explained.h"

#include <limits>

#include "surf/core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/explained.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::HWY_NAMESPACE {

// out(x) = min(out(x), in(x + k) + offset[k] of four).
void lower_to(float* __restrict out, const float* __restrict in, const float* offset, int count) {
  const float a = offset[0], b = offset[1], c = offset[2], d = offset[3];
  for (int x = 0; x < count; ++x) {
    const float v = in[x] + a, w = in[x + 1] + b, y = in[x + 2] + c, z = in[x + 3] + d;
    const float vw = w < v ? w : v, yz = z < y ? z : y, least = yz < vw ? yz : vw;
    out[x] = least < out[x] ? least : out[x];
  }
}

// out(x) = max(out(x), in(x - k) + offset[k] of four); -infinity + infinity does not count.
void raise_to(float* __restrict out, const float* __restrict in, const float* offset, int count) {
  const float a = offset[0], b = offset[1], c = offset[2], d = offset[3];
  for (int x = 0; x < count; ++x) {
    float most = out[x];
    const float v = in[x] + a, w = in[x - 1] + b, y = in[x - 2] + c, z = in[x - 3] + d;
    most = v > most ? v : most;
    most = w > most ? w : most;
    most = y > most ? y : most;
    most = z > most ? z : most;
    out[x] = most;
  }
}

}  // namespace surf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf {
namespace {

HWY_EXPORT(lower_to);
HWY_EXPORT(raise_to);

constexpr float infinity = std::numeric_limits<float>::infinity();

// Samples of the tip per pass, so that the result is loaded and stored once for all of them.
constexpr int together = 4;

// The offsets of samples from (i, j) on; neutral ones beyond the tip.
void offsets(const CarvedTip& tip, int i, int j, float sign, float* four) {
  for (int k = 0; k < together; ++k) {
    const auto at = static_cast<std::size_t>(j * tip.stride + i + k);
    const bool there = i + k < tip.width && tip.z[at] > -infinity;
    four[k] = !there ? -sign * infinity : sign > 0 ? tip.z[at] : tip.threshold[at] - tip.z[at];
  }
}

}  // namespace

std::vector<float> apex_heights(const CarvedScan& scan, const CarvedTip& tip, int threads) {
  // The apex may lie outside the scan by the size of the tip.
  const int w = scan.width() + tip.width - 1, h = scan.height() + tip.height - 1;
  const int left = tip.width - 1 - tip.apex_x, below = tip.height - 1 - tip.apex_y;
  std::vector<float> apex(scan.size(), infinity);
  parallel_for(static_cast<std::size_t>(h), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row) - below;
    float four[together];
    for (int j = 0; j < tip.height; ++j) {
      const int sy = y + j - tip.apex_y;
      if (sy < 0 || sy >= scan.height()) continue;  // beyond the scan everything is allowed
      for (int i = 0; i < tip.width; i += together) {
        offsets(tip, i, j, -1, four);
        HWY_DYNAMIC_DISPATCH(lower_to)
        (apex.data() + scan.offset(-left, y), scan.top(i - tip.apex_x - left, sy), four, w);
      }
    }
  });
  return apex;
}

Grid<float> explained_height(const CarvedScan& scan, const std::vector<float>& apex,
                             const CarvedTip& tip, int threads) {
  Grid<float> out(scan.width(), scan.height(), -infinity);
  parallel_for(static_cast<std::size_t>(scan.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    float four[together];
    for (int j = 0; j < tip.height; ++j)
      for (int i = 0; i < tip.width; i += together) {
        offsets(tip, i, j, 1, four);
        HWY_DYNAMIC_DISPATCH(raise_to)
        (&out(0, y), apex.data() + scan.offset(-(i - tip.apex_x), y - (j - tip.apex_y)), four,
         scan.width());
      }
  });
  return out;
}

}  // namespace surf
#endif
