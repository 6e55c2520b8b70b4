// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/clean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "surf/afm/noise.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

/// Noise, some heights equal, with scattered holes that hold NaN.
HeightField noisy(int width, int height, double holes) {
  HeightField f;
  f.z_nm = simulate_noise({0.5, 1}, width, height, 4);
  f.valid = Mask(width, height, 1);
  RandomStream random(3, 0, 0);
  for (std::size_t i = 0; i < f.z_nm.size(); ++i) {
    if (i % 3 == 0) f.z_nm.data()[i] = std::round(f.z_nm.data()[i]);
    if (random.uniform() < holes) f.valid.data()[i] = 0, f.z_nm.data()[i] = NAN;
  }
  return f;
}

bool inside(const MedianOptions& o, int dx, int dy) {
  return o.neighbourhood == Neighbourhood::square ||
         dx * dx + dy * dy <= (o.radius + 0.5) * (o.radius + 0.5);
}

double median_by_sorting(const HeightField& f, const MedianOptions& o, int x, int y) {
  std::vector<double> all;
  for (int dy = -o.radius; dy <= o.radius; ++dy)
    for (int dx = -o.radius; dx <= o.radius; ++dx) {
      const int u = x + dx, v = y + dy;
      if (u < 0 || v < 0 || u >= f.z_nm.width() || v >= f.z_nm.height()) continue;
      if (inside(o, dx, dy) && f.is_valid(u, v)) all.push_back(f.z_nm(u, v));
    }
  std::sort(all.begin(), all.end());
  const std::size_t n = all.size();
  return n == 0 ? NAN : all[(n - 1) / 2] + 0.5 * (all[n / 2] - all[(n - 1) / 2]);
}

TEST(MedianFilter, IsTheSortedMiddleOfEachNeighbourhood) {
  for (const Neighbourhood shape : {Neighbourhood::square, Neighbourhood::disc}) {
    for (const int radius : {0, 1, 2, 5, 40}) {
      const HeightField f = noisy(37, 29, 0.2);
      const MedianOptions o{.radius = radius, .neighbourhood = shape};
      const auto [out, s] = median_filter(f, o);
      for (int y = 0; y < 29; ++y)
        for (int x = 0; x < 37; ++x) {
          if (f.is_valid(x, y))
            EXPECT_EQ(out.z_nm(x, y), median_by_sorting(f, o, x, y)) << x << " " << y;
          else EXPECT_TRUE(std::isnan(out.z_nm(x, y)));
        }
      EXPECT_EQ(out.valid, f.valid);
      EXPECT_EQ(s.changed == 0, radius == 0);
    }
  }
}

TEST(MedianFilter, GivesTheSameForAnyNumberOfThreads) {
  const HeightField f = noisy(70, 130, 0);
  const Grid<double> one = median_filter(f, {.radius = 3, .threads = 1}).field.z_nm;
  for (const int threads : {2, 5})
    EXPECT_EQ(median_filter(f, {.radius = 3, .threads = threads}).field.z_nm, one);
}

TEST(MedianFilter, FillsHolesIfAskedAndIfItCan) {
  HeightField f = noisy(20, 20, 0);
  for (int y = 5; y < 12; ++y)
    for (int x = 5; x < 12; ++x) f.valid(x, y) = 0;
  const auto [out, s] = median_filter(f, {.radius = 1, .fill_holes = true});
  EXPECT_EQ(s.filled, 49u - 25);
  EXPECT_EQ(s.holes, 25u);
  EXPECT_EQ(out.z_nm(5, 5), median_by_sorting(f, {.radius = 1}, 5, 5));
  EXPECT_FALSE(out.is_valid(8, 8));
}

TEST(MedianFilter, WithALimitTakesSpikesAndLeavesTheRest) {
  HeightField f = noisy(40, 40, 0);
  for (double& z : f.z_nm.data()) z *= 0.01;
  const Grid<double> before = f.z_nm;
  f.z_nm(7, 9) = 30, f.z_nm(0, 0) = -30;
  const auto [out, s] = median_filter(f, {.radius = 1, .limit_nm = 1});
  EXPECT_EQ(s.changed, 2u);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool spike = (x == 7 && y == 9) || (x == 0 && y == 0);
      if (spike) EXPECT_LT(std::fabs(out.z_nm(x, y)), 0.1);
      else EXPECT_EQ(out.z_nm(x, y), before(x, y));
    }
}

TEST(MedianFilter, RefusesImpossibleOptions) {
  EXPECT_THROW(median_filter(noisy(5, 5, 0), {.radius = -1}), UsageError);
  EXPECT_THROW(median_filter(noisy(5, 5, 0), {.limit_nm = -1}), UsageError);
  EXPECT_THROW(median_filter(noisy(5, 5, 0), {.limit_nm = NAN}), UsageError);
}

/// The highest (sign 1) or the lowest (-1) of a square, by looking at all of it.
HeightField extreme(const HeightField& f, int width, int sign) {
  HeightField out = f;
  const int h = width / 2;
  for (int y = 0; y < f.z_nm.height(); ++y)
    for (int x = 0; x < f.z_nm.width(); ++x) {
      double best = -std::numeric_limits<double>::infinity();
      for (int v = std::max(0, y - h); v <= std::min(f.z_nm.height() - 1, y + h); ++v)
        for (int u = std::max(0, x - h); u <= std::min(f.z_nm.width() - 1, x + h); ++u)
          if (f.is_valid(u, v)) best = std::max(best, sign * f.z_nm(u, v));
      out.z_nm(x, y) = sign * best;
      out.valid(x, y) = std::isfinite(best);
    }
  return out;
}

TEST(FlatClosing, IsTheLowestOfTheHighest) {
  for (const int width : {1, 3, 7, 61}) {
    const HeightField f = noisy(37, 29, 0.2);
    const auto [out, s] = flat_closing(f, {.width = width});
    const HeightField expected = extreme(extreme(f, width, 1), width, -1);
    for (int y = 0; y < 29; ++y)
      for (int x = 0; x < 37; ++x)
        if (f.is_valid(x, y)) {
          EXPECT_EQ(out.z_nm(x, y), expected.z_nm(x, y)) << width;
        }
    EXPECT_EQ(out.valid, f.valid);
  }
}

TEST(FlatClosing, OnlyRaisesAndTwiceIsOnce) {
  const HeightField f = noisy(64, 50, 0);
  const auto [once, s] = flat_closing(f, {.width = 5});
  EXPECT_GT(s.changed, 0u);
  for (std::size_t i = 0; i < f.z_nm.size(); ++i) EXPECT_GE(once.z_nm.data()[i], f.z_nm.data()[i]);
  const Cleaned twice = flat_closing(once, {.width = 5});
  EXPECT_EQ(twice.field.z_nm, once.z_nm);
  EXPECT_EQ(twice.summary.changed, 0u);
}

TEST(FlatClosing, FillsNarrowPitsToTheirRimAndLeavesWideOnes) {
  HeightField f;
  f.z_nm = Grid<double>(30, 30, 5.0);
  for (int y = 3; y < 27; ++y) {
    for (const int x : {4, 5}) f.z_nm(x, y) = 0;
    for (int x = 12; x < 25; ++x) f.z_nm(x, y) = 0;
  }
  const auto [out, s] = flat_closing(f, {.width = 3});
  EXPECT_EQ(out.z_nm(4, 10), 5);
  EXPECT_EQ(out.z_nm(18, 10), 0);
  EXPECT_EQ(out.z_nm(12, 3), 0) << "corners of the wide pit stay";
  EXPECT_EQ(s.changed, 2u * 24);
}

TEST(FlatClosing, FillsHolesItReaches) {
  HeightField f = noisy(20, 20, 0);
  for (int y = 5; y < 14; ++y)
    for (int x = 5; x < 14; ++x) f.valid(x, y) = 0;
  const auto [out, s] = flat_closing(f, {.width = 3, .fill_holes = true});
  EXPECT_EQ(s.filled + s.holes, 81u);
  EXPECT_TRUE(out.is_valid(5, 5));
  EXPECT_TRUE(std::isfinite(out.z_nm(5, 5)));
  EXPECT_FALSE(out.is_valid(9, 9));
}

TEST(FlatClosing, RefusesEvenWidths) {
  for (const int width : {0, 4, -3, 100001})
    EXPECT_THROW(flat_closing(noisy(5, 5, 0), {.width = width}), UsageError);
}

}  // namespace
}  // namespace surf
