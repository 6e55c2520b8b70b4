// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/pole_line.h"

#include <gtest/gtest.h>

namespace surf::mc {
namespace {

TEST(PoleLine, IntegratesAndInvertsInClosedForm) {
  for (const double w0 : {0.05, 0.6, 4.0, 60.0}) {
    const PoleLine line(w0);
    for (const double first : {0.01, 0.3, 2.0}) {
      const double last = 5 * first;
      double sum = 0;
      constexpr int n = 20000;
      const double h = std::log(last / first) / n;
      for (int i = 0; i < n; ++i) sum += h / line.loss(first * std::exp((i + 0.5) * h));
      EXPECT_NEAR(line.integral(first, last) / sum, 1, 1e-6) << w0 << ", " << first;
      EXPECT_NEAR(std::sqrt(line.square_of_momentum(line.log_t(last))) / last, 1, 1e-9);
      EXPECT_NEAR(line.momentum(line.loss(last)) / last, 1, 1e-9);
      EXPECT_NEAR(line.slope(last, line.loss(last)),
                  (line.loss(last + 1e-5) - line.loss(last - 1e-5)) / 2e-5, 1e-6);
    }
  }
}

// Aluminium's plasmon, 15 eV, enters the continuum near 1.3 per Angstrom.
TEST(PoleLine, EndsWhereSingleElectronsTakeItsLoss) {
  const PoleLine line(15 / 27.2114);
  EXPECT_TRUE(line.is_collective(0.5, line.loss(0.5)));
  EXPECT_FALSE(line.is_collective(0.9, line.loss(0.9)));
}

}  // namespace
}  // namespace surf::mc
