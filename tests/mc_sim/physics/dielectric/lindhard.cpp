// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/lindhard.h"

#include <gtest/gtest.h>

namespace surf::mc {
namespace {

// The f-sum of a gas at any momentum: its plasmon's and its pairs' losses, weighted with w, add up
// to pi wp^2 / 2.
TEST(Lindhard, FulfilsTheSumRule) {
  for (const double wp : {0.2, 0.55, 1.5}) {
    const Lindhard gas = Lindhard::of_plasma_energy(wp);
    for (const double q : {0.2, 0.6, 1.0, 3.0}) {
      const double k = gas.fermi_momentum(), from = std::max(0.0, 0.5 * q * q - q * k),
                   to = 0.5 * q * q + q * k;
      double sum = 0;
      constexpr int n = 400000;
      for (int i = 0; i < n; ++i) {
        const double w = from + (to - from) * (i + 0.5) / n, a = gas.real(q, w),
                     b = gas.imaginary(q, w);
        sum += w * b / (a * a + b * b) * (to - from) / n;
      }
      if (gas.real(q, to * (1 + 1e-9)) < 0) {  // there is a plasmon beyond
        double low = to, high = 10 * to + 10;
        for (int i = 0; i < 200; ++i)
          (gas.real(q, 0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
        const double slope =
            (gas.real(q, low * (1 + 1e-6)) - gas.real(q, low * (1 - 1e-6))) / (2e-6 * low);
        sum += low * M_PI / slope;
      }
      EXPECT_NEAR(sum / (0.5 * M_PI * wp * wp), 1, 3e-3) << wp << ", " << q;
    }
  }
}

TEST(Lindhard, IsThatOfFreeElectronsFarAway) {
  const Lindhard gas = Lindhard::of_plasma_energy(0.6);
  EXPECT_NEAR(gas.real(1e-3, 0.9), 1 - 0.36 / 0.81, 1e-5);
  EXPECT_NEAR(Lindhard::of_log_plasma_energy(std::log(0.6)).fermi_momentum(), gas.fermi_momentum(),
              1e-12);
  EXPECT_NEAR(Lindhard::plasma_energy(gas.fermi_momentum()), 0.6, 1e-12);
  // The series joins the formula.
  const double q = 0.01, w = 50 * (1 + 0.5 * q / gas.fermi_momentum()) * q * gas.fermi_momentum();
  EXPECT_NEAR(gas.real(q, w * (1 + 1e-9)) / gas.real(q, w * (1 - 1e-9)), 1, 1e-6);
}

// Thomas and Fermi's screening: eps(q, 0) = 1 + k_TF^2 / q^2, k_TF^2 = 4 kF / pi.
TEST(Lindhard, ScreensAsThomasAndFermiSay) {
  const Lindhard gas(1.0);
  const double q = 0.01;
  EXPECT_NEAR((gas.real(q, 1e-9) - 1) * q * q, 4 / M_PI, 1e-3);
}

}  // namespace
}  // namespace surf::mc
