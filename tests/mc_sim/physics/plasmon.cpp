// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/mechanism_test.h"

namespace surf::mc {

TEST(Plasmon, FollowsQuinnsFormula) {
  // Aluminium, hw = 15 eV: EF = 0.29436 * 15^(4/3) = 10.89 eV. At E = 500 eV above the band's
  // bottom 1/lambda = 15 / (2 * 0.0529177 * E) ln{[sqrt(25.89) - sqrt(10.89)] / [sqrt(E) - sqrt(E -
  // 15)]}.
  const Material& al = material("Al");
  const Physics physics;
  const auto plasmon = make_plasmon(al, physics);
  const double fermi = 0.29436 * std::pow(15, 4.0 / 3);
  const double e = 500 - filled_level_ev(al, physics) + fermi;
  const double expected =
      15 / (2 * 0.0529177 * e) *
      std::log((std::sqrt(fermi + 15) - std::sqrt(fermi)) / (std::sqrt(e) - std::sqrt(e - 15)));
  EXPECT_NEAR(plasmon->inverse_mean_free_path_per_nm(500), expected, 1e-9);
  EXPECT_EQ(plasmon->inverse_mean_free_path_per_nm(filled_level_ev(al, physics) + 14.99), 0);
}

TEST(Plasmon, MakesOneIsotropicSecondaryOfItsEnergy) {
  const Material& si = material("Si");
  const Physics physics;
  const auto plasmon = make_plasmon(si, physics);
  RandomStream random(1, 0, 0);
  ScatterEvent event;
  plasmon->scatter(300, random, event);
  EXPECT_TRUE(event.has_secondary);
  EXPECT_DOUBLE_EQ(event.secondary_energy_ev, si.plasmon_ev + filled_level_ev(si, physics));
  EXPECT_EQ(event.cos_theta, 1);
  std::vector<double> edges;
  for (int i = 1; i < 20; ++i) edges.push_back(-1 + i / 10.0);
  expect_sampled(
      *plasmon, 300, 100000, edges, [](const ScatterEvent& s) { return s.secondary_direction.z; },
      [](double c) { return (1 + c) / 2; });
}

TEST(Plasmon, DoesNothingBelowItsThreshold) {
  const auto plasmon = make_plasmon(material("Si"), {});
  RandomStream random(1, 0, 0);
  ScatterEvent event;
  plasmon->scatter(15, random, event);
  EXPECT_FALSE(event.has_secondary);
}

}  // namespace surf::mc
