// SPDX-License-Identifier: GPL-3.0-or-later
#include "baselines/reflectance_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surf::bench {
namespace {

ReflectanceMap secant(double gain, double offset) {
  return reflectance_of({.form = SlopeForm::secant, .channels = {{"SE", 1, {}}}}, {gain}, offset);
}

TEST(ReflectanceMap, SaysWhatItsSlopeModelSays) {
  const ReflectanceMap map = secant(3, 2);
  EXPECT_NEAR(map.level_ground(), 5, 1e-9);
  for (const double slope : {0.0, 0.3, 1.0, 3.0})
    EXPECT_NEAR(map.at(0.6 * slope, -0.8 * slope).r, (2 + 3 * std::hypot(1, slope)) / 5,
                0.004 * std::hypot(1, slope))
        << slope;
}

TEST(ReflectanceMap, HasTheDerivativesOfItsValue) {
  const ReflectanceMap map = secant(1, 0);
  constexpr double step = 1e-6;
  for (const double p : {0.0, 0.01, 0.4, 2.0, 20.0}) {
    const double q = -0.7 * p;
    const ReflectanceMap::Value v = map.at(p, q);
    EXPECT_NEAR(v.by_p, (map.at(p + step, q).r - map.at(p - step, q).r) / (2 * step), 1e-5) << p;
    EXPECT_NEAR(v.by_q, (map.at(p, q + step).r - map.at(p, q - step).r) / (2 * step), 1e-5) << p;
  }
}

TEST(ReflectanceMap, DoesNotTellSigns) {
  const ReflectanceMap map = secant(1, 0);
  EXPECT_EQ(map.at(0.5, 0.2).r, map.at(-0.5, 0.2).r);
  EXPECT_EQ(map.at(0, 0).by_p, 0);
}

}  // namespace
}  // namespace surf::bench
