// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction/sparse_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "afm/normal_numbers.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf::reconstruction {
namespace {

/// Squared second differences with random weights between 1 and `spread`, plus `ground`: the kind
/// of matrix that priors give.
std::shared_ptr<StencilMatrix> make_matrix(int w, int h, double ground, double spread = 100) {
  auto m = std::make_shared<StencilMatrix>(w, h);
  RandomStream random(7, 1, 0);
  const double second[] = {1, -2, 1}, mixed[] = {1, -1, -1, 1};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double weight = std::pow(spread, random.uniform());
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) {
          if (x > 0 && x + 1 < w)
            m->add(x + a - 1, y, x + b - 1, y, weight * second[a] * second[b]);
          if (y > 0 && y + 1 < h)
            m->add(x, y + a - 1, x, y + b - 1, weight * second[a] * second[b]);
        }
      for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b)
          if (x + 1 < w && y + 1 < h)
            m->add(x + a % 2, y + a / 2, x + b % 2, y + b / 2, weight * mixed[a] * mixed[b]);
      m->add(x, y, x, y, ground);
    }
  return m;
}

SparseFactor make_factor(const Area& area, Precision precision = Precision::single_where_it_holds) {
  return {std::make_shared<Dissection>(area.width(), area.height()), precision};
}

Grid<double> random_field(int w, int h, std::uint64_t seed) {
  NormalNumbers normal(seed, 0);
  Grid<double> out(w, h);
  for (double& v : out.data()) v = normal();
  return out;
}

double norm(const Grid<double>& a) {
  double sum = 0;
  for (const double v : a.data()) sum += v * v;
  return std::sqrt(sum);
}

double relative_difference(Grid<double> a, const Grid<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a.data()[i] -= b.data()[i];
  return norm(a) / norm(b);
}

/// x with A x = right, by Gaussian elimination of the full matrix.
Grid<double> dense_solution(const StencilMatrix& m, const Area& area, const Grid<double>& right) {
  const int n = area.samples();
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1));
  for (int k = 0; k < n; ++k) {
    m.for_each_in_column(area, k, [&](int row, double v) { a[row][k] = a[k][row] = v; });
    a[k][n] = right.data()[k];
  }
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const double f = a[i][k] / a[k][k];
      if (f != 0)
        for (int j = k; j <= n; ++j) a[i][j] -= f * a[k][j];
    }
  Grid<double> x(area.width(), area.height());
  for (int k = n - 1; k >= 0; --k) {
    double sum = a[k][n];
    for (int j = k + 1; j < n; ++j) sum -= a[k][j] * x.data()[j];
    x.data()[k] = sum / a[k][k];
  }
  return x;
}

TEST(Dissection, EliminatesEachSampleOnceAndKnowsWhatCouples) {
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 40}, {29, 23}, {30, 8}}) {
    const Dissection d(w, h);
    std::vector<int> sorted = d.sample;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < w * h; ++i) {
      ASSERT_EQ(sorted[i], i);
      ASSERT_EQ(d.sample[d.place[i]], i);
    }
    // Elimination of the graph, sample by sample.
    std::vector<std::set<int>> later(w * h);
    const StencilMatrix m(w, h);
    for (int k = 0; k < w * h; ++k)
      m.for_each_in_column({0, 0, w, h}, k, [&](int row, double) {
        if (row != k)
          later[std::min(d.place[k], d.place[row])].insert(std::max(d.place[k], d.place[row]));
      });
    for (int e = 0; e < w * h; ++e)
      for (const int a : later[e]) later[a].insert(later[e].upper_bound(a), later[e].end());
    int next = 0;
    for (const Front& f : d.fronts) {
      ASSERT_EQ(f.first, next);
      next += f.own;
      // What the last of the front's own samples couples, its border holds.
      const std::set<int>& coupled = later[next - 1];
      EXPECT_TRUE(std::includes(f.border.begin(), f.border.end(), coupled.begin(), coupled.end()));
      EXPECT_EQ(f.border.size(), f.in_parent.size());
    }
    EXPECT_EQ(next, w * h);
  }
}

TEST(SparseFactor, SolvesAsDenseEliminationDoes) {
  const OneBlasThread alone;
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 3}, {5, 4}, {7, 31}, {24, 17}}) {
    SCOPED_TRACE(w);
    // Within a larger matrix, to see that areas are cut out.
    const auto m = make_matrix(w + 5, h + 4, 0.5);
    const Area area{3, 2, 3 + w, 2 + h};
    SparseFactor single = make_factor(area), twice = make_factor(area, Precision::double_always);
    single.compute(m, area);
    twice.compute(m, area);
    EXPECT_TRUE(single.is_single());
    EXPECT_FALSE(twice.is_single());
    std::vector<Grid<double>> x{random_field(w, h, 1), random_field(w, h, 2)}, coarse = x,
                                                                               exact = x;
    std::vector<Grid<double>> expected;
    for (const Grid<double>& right : x) expected.push_back(dense_solution(*m, area, right));
    single.solve(x);
    single.solve_coarsely(coarse);
    twice.solve(exact);
    for (int k = 0; k < 2; ++k) {
      EXPECT_LT(relative_difference(x[k], expected[k]), 1e-12);
      EXPECT_LT(relative_difference(exact[k], expected[k]), 1e-12);
      EXPECT_LT(relative_difference(coarse[k], expected[k]), 1e-4);
    }
  }
}

TEST(SparseFactor, RefinementReachesDoublePrecision) {
  const OneBlasThread alone;
  const Area area{0, 0, 60, 50};
  // The largest eigenvalue is some thousands, the least the ground: conditions of 1e4 to 1e6.
  for (const double ground : {1.0, 0.1, 0.01}) {
    const auto m = make_matrix(60, 50, ground);
    SparseFactor single = make_factor(area), twice = make_factor(area, Precision::double_always);
    single.compute(m, area);
    twice.compute(m, area);
    ASSERT_TRUE(single.is_single()) << ground;
    const Grid<double> right = random_field(60, 50, 3);
    std::vector<Grid<double>> x{right}, coarse{right}, exact{right};
    single.solve(x);
    single.solve_coarsely(coarse);
    twice.solve(exact);
    EXPECT_TRUE(single.is_single());
    const auto residual = [&](const Grid<double>& solution) {
      Grid<double> r = right;
      m->subtract_product(area, solution, r);
      return norm(r);
    };
    EXPECT_LT(residual(x[0]), 2 * residual(exact[0]));
    EXPECT_GT(residual(coarse[0]), 1e4 * residual(exact[0]));
    EXPECT_LT(relative_difference(x[0], exact[0]), 1e-15 / ground * 1e4);
  }
}

TEST(SparseFactor, FallsBackToDoublePrecisionAndComesBack) {
  const OneBlasThread alone;
  const Area area{0, 0, 60, 50};
  SparseFactor factor = make_factor(area);
  // Conditions of 1e9 and more. At the first, single precision finds a factor, but surfaces of long
  // waves are lost; at the last, it finds none.
  for (const double ground : {1e-5, 1e-6, 1e-8}) {
    const auto m = make_matrix(60, 50, ground);
    factor.compute(m, area);
    EXPECT_FALSE(factor.is_single()) << ground;
    const Grid<double> right = random_field(60, 50, 3);
    std::vector<Grid<double>> x{right};
    factor.solve(x);
    Grid<double> r = right;
    m->subtract_product(area, x[0], r);
    EXPECT_LT(norm(r), 1e-5 * norm(right));
  }
  factor.compute(make_matrix(60, 50, 1), area);
  EXPECT_TRUE(factor.is_single());
  EXPECT_LT(factor.error(), 1e-3);
  EXPECT_GT(factor.error(), 0);
}

TEST(SparseFactor, RefinementThatDoesNotConvergeIsGivenUpForDoublePrecision) {
  const OneBlasThread alone;
  const Area area{0, 0, 20, 20};
  const auto m = std::make_shared<StencilMatrix>(20, 20);
  for (int k = 0; k < 400; ++k) m->add(k % 20, k / 20, k % 20, k / 20, 1);
  // Single precision makes 6e-8 of it; a smooth surface does not show that.
  m->add(7, 5, 8, 5, 3e-8 - 1);
  SparseFactor factor = make_factor(area);
  factor.compute(m, area);
  ASSERT_TRUE(factor.is_single());
  const Grid<double> right = random_field(20, 20, 1);
  std::vector<Grid<double>> x{right};
  factor.solve(x);
  EXPECT_FALSE(factor.is_single());
  Grid<double> r = right;
  m->subtract_product(area, x[0], r);
  EXPECT_LT(norm(r), 1e-8 * norm(right));
}

TEST(SparseFactor, MatricesThatAreNotPositiveDefiniteAreRefused) {
  const OneBlasThread alone;
  const Area area{0, 0, 9, 8};
  SparseFactor factor = make_factor(area);
  EXPECT_THROW(factor.compute(make_matrix(9, 8, -1), area), InvalidInput);
}

TEST(SparseFactor, MatricesOfAnySizeAreSolved) {
  // Numbers that single precision cannot hold as they are.
  const OneBlasThread alone;
  const Area area{0, 0, 20, 20};
  for (const double size : {1e-60, 1e60}) {
    const auto plain = make_matrix(20, 20, 1);
    auto m = std::make_shared<StencilMatrix>(20, 20);
    for (int k = 0; k < 400; ++k)
      plain->for_each_in_column(area, k, [&](int row, double v) {
        m->add(row % 20, row / 20, k % 20, k / 20, size * v);
      });
    SparseFactor factor = make_factor(area);
    factor.compute(m, area);
    EXPECT_TRUE(factor.is_single()) << size;
    std::vector<Grid<double>> x{random_field(20, 20, 1)};
    const Grid<double> expected = dense_solution(*m, area, x[0]);
    factor.solve(x);
    EXPECT_LT(relative_difference(x[0], expected), 1e-12) << size;
  }
}

TEST(SparseFactor, DrawsOfBothPrecisionsAgree) {
  const OneBlasThread alone;
  const Area area{0, 0, 45, 52};
  const auto m = make_matrix(45, 52, 0.1);
  SparseFactor single = make_factor(area), twice = make_factor(area, Precision::double_always);
  single.compute(m, area);
  twice.compute(m, area);
  ASSERT_TRUE(single.is_single());
  std::vector<Grid<double>> a{random_field(45, 52, 4), random_field(45, 52, 5)}, b = a;
  single.draw(a);
  twice.draw(b);
  for (int k = 0; k < 2; ++k) EXPECT_LT(relative_difference(a[k], b[k]), 1e-3);
}

TEST(SparseFactor, SeveralAtOnceAreTheBytesOfOneByOne) {
  const OneBlasThread alone;
  const Area area{0, 0, 45, 52};
  SparseFactor factor = make_factor(area), again = make_factor(area);
  factor.compute(make_matrix(45, 52, 5, 10), area);
  for (SparseFactor* f : {&factor, &again}) f->compute(make_matrix(45, 52, 0.1), area);
  std::vector<Grid<double>> all;
  for (int k = 0; k < 5; ++k) all.push_back(random_field(45, 52, k));
  const std::vector<Grid<double>> right = all;
  factor.solve_coarsely(all);
  for (int k = 0; k < 5; ++k) {
    std::vector<Grid<double>> one{right[k]};
    again.solve_coarsely(one);
    EXPECT_EQ(one[0], all[k]) << k;
  }
}

}  // namespace
}  // namespace surf::reconstruction
