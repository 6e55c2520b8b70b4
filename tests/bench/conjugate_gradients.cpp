// SPDX-License-Identifier: GPL-3.0-or-later
#include "baselines/conjugate_gradients.h"

#include <gtest/gtest.h>

namespace surf::bench {
namespace {

TEST(ConjugateGradients, FindTheLeastOfAQuadratic) {
  std::vector<double> at(20, 0.0);
  const double least = conjugate_gradients(
      [](const std::vector<double>& x, std::vector<double>& gradient) {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
          const double stiff = 1 + static_cast<double>(i), d = x[i] - 3;
          sum += stiff * d * d;
          gradient[i] = 2 * stiff * d;
        }
        return sum;
      },
      at, {200, 1e-14});
  EXPECT_LT(least, 1e-6);
  for (const double x : at) EXPECT_NEAR(x, 3, 1e-3);
}

TEST(ConjugateGradients, FollowRosenbrocksValley) {
  std::vector<double> at{-1.2, 1};
  conjugate_gradients(
      [](const std::vector<double>& x, std::vector<double>& gradient) {
        const double a = 1 - x[0], b = x[1] - x[0] * x[0];
        gradient = {-2 * a - 400 * x[0] * b, 200 * b};
        return a * a + 100 * b * b;
      },
      at, {1000, 1e-10});
  EXPECT_NEAR(at[0], 1, 1e-2);
  EXPECT_NEAR(at[1], 1, 2e-2);
}

}  // namespace
}  // namespace surf::bench
