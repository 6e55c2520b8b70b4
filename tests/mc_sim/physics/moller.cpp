// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/directions.h"
#include "physics/mechanism_test.h"

namespace surf::mc {

namespace {

double density(double eps) {
  return 1 / (eps * eps) + 1 / ((1 - eps) * (1 - eps)) - 1 / (eps * (1 - eps));
}

}  // namespace

TEST(Moller, RateAndPowerAreIntegralsOfTheCrossSection) {
  for (const char* name : {"Si", "Al", "Au"}) {
    const Material& m = material(name);
    const Physics physics;
    const auto moller = make_moller(m, physics);
    const double level = filled_level_ev(m, physics);
    const double electrons =
        602.214076 * m.density_g_cm3 * m.valence_electrons / m.constituents[0].atomic_weight;
    for (const double e : {12.0, 60.0, 1000.0, 20000.0}) {
      const double least = m.work_function_ev / e;
      const double unit = electrons * 6.5141 / (e * e);
      EXPECT_NEAR(
          moller->inverse_mean_free_path_per_nm(e + level) / (unit * integral(density, least, 0.5)),
          1, 1e-6);
      EXPECT_NEAR(moller->secondary_power_ev_per_nm(e + level) /
                      (unit * e * integral([](double x) { return x * density(x); }, least, 0.5)),
                  1, 1e-6);
    }
    EXPECT_EQ(moller->inverse_mean_free_path_per_nm(2 * m.work_function_ev + level - 1e-9), 0);
  }
}

TEST(Moller, SamplesTheEnergyHandedOver) {
  const Material& si = material("Si");
  const Physics physics;
  const auto moller = make_moller(si, physics);
  const double level = filled_level_ev(si, physics);
  for (const double energy : {12.0, 100.0, 5000.0}) {
    const double e = energy - level, least = si.work_function_ev / e;
    const double all = integral(density, least, 0.5);
    std::vector<double> edges;
    for (int i = 1; i < 15; ++i) edges.push_back(least * std::pow(0.5 / least, i / 15.0));
    expect_sampled(
        *moller, energy, 100000, edges,
        [&](const ScatterEvent& s) { return (s.secondary_energy_ev - level) / e; },
        [&](double eps) { return integral(density, least, eps) / all; }, 3);
  }
}

// Two free electrons: momenta add up to the old one, energies to the old energy.
TEST(Moller, ConservesMomentumOfTheTwoElectrons) {
  const Material& si = material("Si");
  const Physics physics;
  const auto moller = make_moller(si, physics);
  const double energy = 800, level = filled_level_ev(si, physics), e = energy - level;
  RandomStream random(3, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    ScatterEvent s;
    moller->scatter(energy, random, s);
    const double given = s.secondary_energy_ev - level;
    const double p1 = std::sqrt(e - given), p2 = std::sqrt(given);
    EXPECT_NEAR(p1 * s.cos_theta + p2 * s.secondary_direction.z, std::sqrt(e), 1e-9);
    EXPECT_NEAR(p1 * std::sqrt(1 - s.cos_theta * s.cos_theta),
                p2 * std::sqrt(1 - s.secondary_direction.z * s.secondary_direction.z), 1e-6);
    const Vec3 own = from_axis(s.cos_theta, s.turn), across{own.x, own.y, 0};
    EXPECT_NEAR(dot(s.secondary_direction, across),
                -length(across) * std::sqrt(1 - s.secondary_direction.z * s.secondary_direction.z),
                1e-6)
        << "on the other side";
    EXPECT_LE(s.secondary_energy_ev, energy);
    EXPECT_EQ(s.energy_loss_ev, 0);
  }
}

}  // namespace surf::mc
