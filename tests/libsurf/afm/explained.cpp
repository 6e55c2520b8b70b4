// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm/explained.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surf/core/random.h"
#include "vector_targets.h"

namespace surf {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// A shallow bowl: which samples matter hangs on the noise and the spikes of a scan.
CarvedTip tip_of(int width, int height, float threshold) {
  CarvedTip tip;
  tip.width = width, tip.height = height;
  tip.apex_x = width / 3, tip.apex_y = 2 * height / 3;
  tip.stride = (width + 15) / 16 * 16;
  tip.z.assign(static_cast<std::size_t>(tip.stride * height), -infinity);
  tip.threshold.assign(tip.z.size(), 0);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const auto k = static_cast<std::size_t>(j * tip.stride + i);
      const float dx = static_cast<float>(i - tip.apex_x), dy = static_cast<float>(j - tip.apex_y);
      tip.z[k] = -0.003f * (dx * dx + 1.3f * dy * dy) - 0.002f * std::max(0.0f, dx);
      tip.threshold[k] = threshold;
    }
  return tip;
}

// Noise, few spikes and pits, and holes: NaN.
Grid<float> heights_of(int width, int height) {
  RandomStream random(9, 0, 0);
  Grid<float> z(width, height);
  for (float& v : z.data()) {
    v = static_cast<float>(0.1 * random.uniform());
    const double kind = random.uniform();
    if (kind < 0.01) v += 1;
    else if (kind < 0.02) v -= 1;
    else if (kind < 0.025) v = NAN;
  }
  return z;
}

float at(const Grid<float>& z, int x, int y) {
  const bool there = x >= 0 && y >= 0 && x < z.width() && y < z.height();
  return there && !std::isnan(z(x, y)) ? z(x, y) : infinity;
}

// The definition of both, with as many apex positions beyond the scan as the tip is large.
struct Naive {
  Grid<float> apex, made;
};
Naive naive(const Grid<float>& z, const CarvedTip& t) {
  const int w = z.width(), h = z.height();
  Naive out{Grid<float>(w + 2 * t.width, h + 2 * t.height, infinity), Grid<float>(w, h, -infinity)};
  const auto each = [&](const auto& work) {
    for (int j = 0; j < t.height; ++j)
      for (int i = 0; i < t.width; ++i)
        work(static_cast<std::size_t>(j * t.stride + i), i - t.apex_x, j - t.apex_y);
  };
  for (int y = -t.height; y < h + t.height; ++y)
    for (int x = -t.width; x < w + t.width; ++x)
      each([&](std::size_t k, int dx, int dy) {
        float& a = out.apex(x + t.width, y + t.height);
        a = std::min(a, at(z, x + dx, y + dy) + (t.threshold[k] - t.z[k]));
      });
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      each([&](std::size_t k, int dx, int dy) {
        out.made(x, y) =
            std::max(out.made(x, y), out.apex(x - dx + t.width, y - dy + t.height) + t.z[k]);
      });
  return out;
}

// Widths of one block and several, with a rest; odd and even heights.
TEST(ExplainedHeight, IsTheDefinitionToTheLastBit) {
  for (const auto& [width, height] : {std::pair(300, 31), {64, 24}, {33, 40}})
    for (const auto& [tip_width, tip_height] : {std::pair(21, 17), {6, 9}, {33, 3}, {1, 1}})
      for (const float threshold : {0.0f, 0.05f}) {
        const CarvedTip tip = tip_of(tip_width, tip_height, threshold);
        const Grid<float> z = heights_of(width, height);
        const CarvedScan scan(z, 0, tip_width, tip_height);
        const Naive expected = naive(z, tip);
        for (const std::int64_t target : test::vector_targets())
          for (const int threads : {1, 3}) {
            const test::OnlyTarget only(target);
            const std::vector<float> apex = apex_heights(scan, tip, threads);
            const Grid<float> made = explained_height(scan, apex, tip, threads);
            EXPECT_TRUE(made == expected.made)
                << width << " by " << tip_width << ", " << test::name_of_target(target);
            // Where a tip can touch the scan.
            int wrong = 0;
            const int left = tip.width - 1 - tip.apex_x, below = tip.height - 1 - tip.apex_y;
            for (int y = -below; y < height + tip.apex_y; ++y)
              for (int x = -left; x < width + tip.apex_x; ++x)
                wrong += apex[scan.offset(x, y)] != expected.apex(x + tip_width, y + tip_height);
            EXPECT_EQ(wrong, 0) << width << " by " << tip_width << ", "
                                << test::name_of_target(target);
          }
      }
}

}  // namespace
}  // namespace surf
