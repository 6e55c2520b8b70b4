// SPDX-License-Identifier: GPL-3.0-or-later
#include "afm/max_plus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "surf/core/random.h"
#include "vector_targets.h"

namespace surf::max_plus {
namespace {

Grid<Quanta> random_grid(std::uint64_t seed, int width, int height, int depth,
                         double unknown_share) {
  RandomStream random(seed, 0, 0);
  Grid<Quanta> grid(width, height);
  for (Quanta& z : grid.data())
    z = random.uniform() < unknown_share ? unknown : -static_cast<Quanta>(random.uniform() * depth);
  return grid;
}

struct Naive {
  Grid<Quanta> sum;
  Grid<std::int32_t> contact;
};

// The definition, and the rule for ties, word by word.
Naive naive(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y) {
  Naive out{Grid<Quanta>(a.width(), a.height(), unknown),
            Grid<std::int32_t>(a.width(), a.height(), -1)};
  const auto earlier = [](int p, int q, int apex) {
    const int dp = std::abs(p - apex), dq = std::abs(q - apex);
    return dp != dq ? dp < dq : p < q;
  };
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int j = 0; j < b.height(); ++j)
        for (int i = 0; i < b.width(); ++i) {
          const int X = x - i + apex_x, Y = y - j + apex_y;
          if (X < 0 || Y < 0 || X >= a.width() || Y >= a.height()) continue;
          if (a(X, Y) == unknown || b(i, j) == unknown) continue;
          const Quanta z = a(X, Y) + b(i, j);
          const int i0 = out.contact(x, y) % b.width(), j0 = out.contact(x, y) / b.width();
          const bool wins_tie =
              z == out.sum(x, y) && (j != j0 ? earlier(j, j0, apex_y) : earlier(i, i0, apex_x));
          if (z < out.sum(x, y) || (z == out.sum(x, y) && !wins_tie)) continue;
          out.sum(x, y) = z;
          out.contact(x, y) = i + j * b.width();
        }
  return out;
}

void expect_like_naive(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y) {
  const Naive expected = naive(a, b, apex_x, apex_y);
  Grid<Quanta> sum;
  Grid<std::int32_t> contact;
  for (const int threads : {1, 3}) {
    convolve(a, b, apex_x, apex_y, threads, sum);
    EXPECT_EQ(sum, expected.sum);
    convolve(a, b, apex_x, apex_y, threads, sum, &contact);
    EXPECT_EQ(sum, expected.sum);
    EXPECT_EQ(contact, expected.contact);
  }
}

class MaxPlus : public testing::TestWithParam<std::int64_t> {
  const test::OnlyTarget target_{GetParam()};
};

std::string name_of(const testing::TestParamInfo<std::int64_t>& target) {
  return test::name_of_target(target.param);
}

}  // namespace

TEST_P(MaxPlus, IsTheDefinition) {
  const struct {
    int w, h, tw, th, ax, ay;
  } cases[] = {{1, 1, 1, 1, 0, 0},
               {33, 20, 5, 7, 1, 6},
               {130, 9, 41, 3, 40, 0},
               {17, 40, 9, 30, 0, 29},
               {6, 5, 15, 21, 7, 3}};
  for (const auto& c : cases)
    for (const int depth : {3, 1000, 1 << 28})  // 3: full of ties
      for (const double holes : {0.0, 0.3, 1.0}) {
        SCOPED_TRACE(testing::Message() << c.w << " x " << c.h << " by " << c.tw << " x " << c.th
                                        << ", depth " << depth << ", holes " << holes);
        expect_like_naive(random_grid(1, c.w, c.h, depth, holes),
                          random_grid(2, c.tw, c.th, depth, holes / 2), c.ax, c.ay);
      }
}

// Where whole lines and chunks are left out: smooth, steep, with a second peak far from the apex.
TEST_P(MaxPlus, LeavesOutOnlyWhatCannotCount) {
  Grid<Quanta> a(200, 60), b(31, 27);
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) a(x, y) = -((x * x + 3 * y * y) % 10007) / 50 * 50;
  for (int y = 0; y < b.height(); ++y)
    for (int x = 0; x < b.width(); ++x)
      b(x, y) = -std::min((x - 4) * (x - 4) + (y - 20) * (y - 20),
                          2 * ((x - 27) * (x - 27) + (y - 2) * (y - 2))) *
                25;
  expect_like_naive(a, b, 4, 20);
}

TEST_P(MaxPlus, HoldsTheWholeRange) {
  Grid<Quanta> a(3, 1), b(2, 1);
  a.data() = {0, lowest, unknown};
  b.data() = {0, lowest};
  Grid<Quanta> sum;
  convolve(a, b, 0, 0, 1, sum);
  EXPECT_EQ(sum.data(), (std::vector<Quanta>{0, lowest, unknown}));
}

INSTANTIATE_TEST_SUITE_P(Targets, MaxPlus, testing::ValuesIn(test::vector_targets()), name_of);

}  // namespace surf::max_plus
