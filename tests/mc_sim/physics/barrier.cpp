// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/barrier.h"

#include "statistics.h"
#include "surf/core/random.h"

namespace surf::mc {

TEST(Barrier, QuantumTransmissionFollowsTheStep) {
  EXPECT_DOUBLE_EQ(transmission(BarrierModel::quantum, 10, 0), 1);
  EXPECT_EQ(transmission(BarrierModel::quantum, 4, 4), 0);
  EXPECT_EQ(transmission(BarrierModel::quantum, 3, 4), 0);
  // k2 = k1 / 2 at normal = 4/3 step: T = 4 * 1/2 / (3/2)^2 = 8/9.
  EXPECT_NEAR(transmission(BarrierModel::quantum, 4, 3), 8.0 / 9, 1e-14);
  // The same both ways.
  EXPECT_NEAR(transmission(BarrierModel::quantum, 1, -3), 8.0 / 9, 1e-14);
}

TEST(Barrier, ClassicalTransmissionIsAllOrNothing) {
  EXPECT_EQ(transmission(BarrierModel::classical, 4.1, 4), 1);
  EXPECT_EQ(transmission(BarrierModel::classical, 3.9, 4), 0);
  EXPECT_EQ(transmission(BarrierModel::off, 3.9, 4), 1);
}

TEST(Barrier, KeepsTangentialMomentumAndEnergy) {
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 normal =
        normalized({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
    const Vec3 before =
        normalized({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
    const double energy = 1 + 20 * random.uniform(), step = 8 * (random.uniform() - 0.5);
    Vec3 after = before;
    double left = energy;
    const bool across = cross_barrier(BarrierModel::quantum, normal, step, after, left, random);
    EXPECT_NEAR(left, across ? energy - step : energy, 1e-12);
    const Vec3 p0 = before * std::sqrt(energy), p1 = after * std::sqrt(left);
    EXPECT_LT(length(cross(normal, p1 - p0)), 1e-9);
    EXPECT_EQ(dot(before, normal) * dot(after, normal) > 0, across);
    EXPECT_NEAR(length(after), 1, 1e-12);
  }
}

// An isotropic gas behind a classical barrier U: of the electrons that arrive (cosine-weighted) the
// fraction 1 - U/E escapes, and leaves with a cosine law.
TEST(Barrier, LetsTheRightShareOfAnIsotropicGasOut) {
  const double energy = 10, barrier = 4;
  const int n = 200000;
  std::int64_t out = 0;
  std::vector<std::int64_t> cosines(20);
  RandomStream random(2, 0, 0);
  for (int i = 0; i < n; ++i) {
    const double c = std::sqrt(random.uniform());
    Vec3 d{std::sqrt(1 - c * c), 0, c};
    double e = energy;
    if (!cross_barrier(BarrierModel::classical, {0, 0, 1}, barrier, d, e, random)) continue;
    ++out;
    ++cosines[static_cast<std::size_t>(std::min(19.0, d.z * d.z * 20))];
  }
  const double p = 1 - barrier / energy;
  test::expect_mean(static_cast<double>(out) / n, std::sqrt(p * (1 - p) / n), p, 2);
  test::expect_distributed(cosines, std::vector<double>(20, static_cast<double>(out) / 20), 2);
}

}  // namespace surf::mc
