// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/phonons.h"

#include <cmath>
#include <numbers>

#include "physics/mechanism_test.h"

namespace surf::mc {
namespace {

// By the formula of Kieft and Bosch, in SI units: silicon, both branches, below a quarter of the
// zone's edge.
TEST(AcousticPhonons, ScatterAsTheFormulaSays) {
  const Material& si = material("Si");
  const auto phonons = make_acoustic_phonons(si, *si.dielectric);
  const double e = 1.602176634e-19, hbar = 1.054571817e-34, m = 9.1093837e-31;
  const auto rate = [&](double deformation_ev, double speed) {
    const double masses = std::sqrt(0.26 * 1.08 * 1.08 * 1.08) * m * m;
    return masses * deformation_ev * e * deformation_ev * e * 0.0252489 * e /
           (std::numbers::pi * std::pow(hbar, 4) * speed * speed * 2330) * 1e-9;
  };
  const double energy = 0.1, edge = 5.0998,
               a = energy / (5 * edge);  // above the conduction band's bottom
  const double expected = (rate(9.2, 9130) + 2 * rate(5.0, 5842)) / (1 + a);
  EXPECT_NEAR(
      phonons->inverse_mean_free_path_per_nm(si.dielectric->band.free_ev() + energy) / expected, 1,
      2e-3);
  EXPECT_EQ(phonons->inverse_mean_free_path_per_nm(si.dielectric->band.free_ev() - 0.1), 0);
}

TEST(AcousticPhonons, DrawTheirAngles) {
  const Material& si = material("Si");
  const auto phonons = make_acoustic_phonons(si, *si.dielectric);
  // Far above the zone's edge: mu / (1 + mu E / A)^2, whose integral is ln(1 + x) + 1 / (1 + x) -
  // 1, x = mu E / A.
  const double above = 40, scale = 5 * 5.0998;
  const int bin = EnergyBins::bin(above);  // tables are of the middles of bins
  const double middle = 0.5 * (EnergyBins::lower_ev(bin) + EnergyBins::lower_ev(bin + 1)) / scale;
  const auto integral = [](double x) { return std::log1p(x) + 1 / (1 + x) - 1; };
  std::vector<double> edges;
  for (int i = 1; i < 12; ++i) edges.push_back(i / 12.0);
  expect_sampled(
      *phonons, si.dielectric->band.free_ev() + above, 100000, edges,
      [](const ScatterEvent& event) { return 0.5 * (1 - event.cos_theta); },
      [&](double mu) { return integral(mu * middle) / integral(middle); }, 4);
}

// More is emitted than absorbed: up to the zone's quantum times tanh(hw / 2 kT), 52 meV times 0.77
// for the longitudinal branch.
TEST(AcousticPhonons, TakeALittleEnergy) {
  const Material& si = material("Si");
  const auto phonons = make_acoustic_phonons(si, *si.dielectric);
  EXPECT_TRUE(phonons->debits());
  RandomStream random(1, 2, 3);
  double most = 0;
  for (int i = 0; i < 10000; ++i) {
    ScatterEvent event;
    phonons->scatter(si.dielectric->band.free_ev() + 20, random, event);
    EXPECT_GE(event.energy_loss_ev, 0);
    most = std::max(most, event.energy_loss_ev);
  }
  EXPECT_NEAR(most, 0.040, 0.003);
}

// With the first tier they turn electrons round, counted from its band, and its continuous loss
// pays: cascades can be joined.
TEST(AcousticPhonons, TakeNothingWhereLossIsContinuous) {
  const Material& si = material("Si");
  const auto paid = make_acoustic_phonons(si, *si.dielectric, false),
             own = make_acoustic_phonons(si, *si.dielectric);
  EXPECT_DOUBLE_EQ(paid->inverse_mean_free_path_per_nm(20),
                   own->inverse_mean_free_path_per_nm(20 + si.dielectric->band.free_ev()));
  EXPECT_FALSE(paid->debits());
  RandomStream random(1, 2, 3);
  ScatterEvent event;
  paid->scatter(20, random, event);
  EXPECT_EQ(event.energy_loss_ev, 0);
  Physics physics;
  parse_physics("elastic=mott-phonon", physics);
  EXPECT_TRUE(make_medium(si, physics).loses_continuously());
}

// 1 / tau = n e^2 rho / m at the Fermi energy: aluminium, 18.1 electrons a nm^3 more or
// less, 2.65e-8 ohm m.
TEST(AcousticPhonons, HaveTheResistivityOfAMetal) {
  const Material& al = material("Al");
  const DielectricData& d = *al.dielectric;
  const auto phonons = make_acoustic_phonons(al, d);
  RandomStream random(1, 2, 4);
  double mean = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    ScatterEvent event;
    phonons->scatter(d.band.filled_ev, random, event);
    mean += (1 - event.cos_theta) / n;
  }
  const double speed = std::sqrt(2 * d.band.filled_ev * 1.602176634e-19 / 9.1093837e-31);
  const double kf = std::sqrt(d.band.filled_ev / 0.0380998),
               electrons = kf * kf * kf / (3 * std::numbers::pi * std::numbers::pi) * 1e27;
  const double tau = 9.1093837e-31 / (electrons * 1.602176634e-19 * 1.602176634e-19 * 2.65e-8);
  EXPECT_NEAR(phonons->inverse_mean_free_path_per_nm(d.band.filled_ev) * mean * speed * 1e9 * tau,
              1, 0.03);
}

// What has neither a measured deformation potential nor a resistivity joins Mott's transport.
TEST(AcousticPhonons, JoinTheAtomsWhereNothingIsKnown) {
  const Material& c = material("C");
  const auto phonons = make_acoustic_phonons(c, *c.dielectric);
  RandomStream random(1, 2, 5);
  double mean = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    ScatterEvent event;
    phonons->scatter(100, random, event);
    mean += (1 - event.cos_theta) / n;
  }
  EXPECT_NEAR(
      phonons->inverse_mean_free_path_per_nm(100) * mean / inverse_transport_path_per_nm(c, 100), 1,
      0.03);
}

TEST(Fade, GoesFromPhononsToAtomsBetween100And200Ev) {
  const Material& si = material("Si");
  const auto slow = make_acoustic_phonons(si, *si.dielectric);
  const auto fast = make_mott(si, si.constituents[0], MottAtoms::solid);
  std::vector<std::unique_ptr<const Scattering>> atoms;
  atoms.push_back(make_mott(si, si.constituents[0], MottAtoms::solid));
  const auto parts = fade(make_acoustic_phonons(si, *si.dielectric), std::move(atoms));
  ASSERT_EQ(parts.size(), 2u);
  const auto rates = [&](double energy) {
    return std::pair{parts[0]->inverse_mean_free_path_per_nm(energy),
                     parts[1]->inverse_mean_free_path_per_nm(energy)};
  };
  EXPECT_EQ(rates(90).first, 0);
  EXPECT_DOUBLE_EQ(rates(90).second, slow->inverse_mean_free_path_per_nm(90));
  EXPECT_DOUBLE_EQ(rates(300).first, fast->inverse_mean_free_path_per_nm(300));
  EXPECT_EQ(rates(300).second, 0);
  const double middle = std::sqrt(100.0 * 200);
  const auto [of_atoms, of_phonons] = rates(middle);
  EXPECT_NEAR(of_atoms, of_phonons, 1e-9);
  EXPECT_NEAR(of_atoms + of_phonons,
              std::sqrt(slow->inverse_mean_free_path_per_nm(middle) *
                        fast->inverse_mean_free_path_per_nm(middle)),
              1e-9);
}

TEST(OpticalPhonons, FollowFroehlich) {
  const DielectricData& d = *material("SiO2").dielectric;
  const OpticalMode mode{0.153, 2.25, 3.05};
  const auto phonons = make_optical_phonons(mode, d);
  const double energy = 5, x = 0.153 / energy, root = std::sqrt(1 - x),
               at = d.band.free_ev() + energy;
  const double n = 1 / std::expm1(0.153 / 0.0252489);
  EXPECT_NEAR(
      phonons->inverse_mean_free_path_per_nm(at),
      0.5 * (1 + n) * (1 / 2.25 - 1 / 3.05) * x / 0.0529177 * std::log((1 + root) / (1 - root)),
      1e-6);
  EXPECT_EQ(phonons->inverse_mean_free_path_per_nm(d.band.free_ev() + 0.15), 0);
  // P(cos > c) goes as the logarithm of q^2: d(cos) / (2 - x - 2 root cos).
  std::vector<double> edges;
  for (int i = 1; i < 12; ++i) edges.push_back(-1 + i / 6.0);
  const auto log_q2 = [&](double c) { return std::log(2 - x - 2 * root * c); };
  expect_sampled(
      *phonons, at, 100000, edges, [](const ScatterEvent& event) { return event.cos_theta; },
      [&](double c) { return (log_q2(-1) - log_q2(c)) / (log_q2(-1) - log_q2(1)); });
  RandomStream random(1, 2, 3);
  ScatterEvent event;
  phonons->scatter(at, random, event);
  EXPECT_EQ(event.energy_loss_ev, 0.153);
}

TEST(PolaronTraps, EndTheWayOfSlowElectrons) {
  const DielectricData& d = *material("PMMA").dielectric;
  const auto traps = make_polaron_traps(d);
  EXPECT_NEAR(traps->inverse_mean_free_path_per_nm(d.band.free_ev() + 4), 0.02 * std::exp(-1.0),
              1e-9);
  RandomStream random(1, 2, 3);
  ScatterEvent event;
  traps->scatter(d.band.free_ev() + 4, random, event);
  EXPECT_EQ(event.energy_loss_ev, d.band.free_ev() + 4);
}

}  // namespace
}  // namespace surf::mc
