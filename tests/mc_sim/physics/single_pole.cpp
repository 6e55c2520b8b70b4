// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/single_pole.h"

#include <gtest/gtest.h>

#include <cmath>

#include "csv.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/dielectric_data.h"

namespace surf::mc {
namespace {

constexpr double hartree_ev = 27.211386246;

DielectricData data_of(const std::string& name) {
  return *io::find_material(name, "test").dielectric;
}

// Tanuma, Powell and Penn (2011), full Penn algorithm; energies count from the Fermi level.
TEST(SinglePole, HasThePublishedFreePaths) {
  for (const auto& row : test::read_reference("imfp_full_penn.csv")) {
    const double energy_ev = std::stod(row.at("energy_ev"));
    if (energy_ev < 99) continue;
    for (const char* name : {"Au", "Cu", "Si", "Ni", "Ge", "Ag", "W"}) {
      const DielectricData d = data_of(name);
      const double path =
          1 / SinglePole(d.elf, d.band).inverse_mean_free_path_per_nm(energy_ev + d.band.filled_ev);
      EXPECT_NEAR(path / std::stod(row.at(name)), 1, 0.08) << name << ", " << energy_ev << " eV";
    }
  }
}

// Above 2 keV. Electrons cannot be told apart: what counts is the loss of the faster one.
TEST(SinglePole, LosesAsMuchAsTheLossFormulaAtHighEnergies) {
  for (const auto& row : test::read_reference("stopping_joyluo.csv")) {
    const std::string name = row.at("element");
    if (name != "Al" && name != "Si" && name != "Cu" && name != "Ag" && name != "Au" &&
        name != "Ni" && name != "Ge")
      continue;
    const DielectricData d = data_of(name);
    const SinglePole losses(d.elf, d.band);
    for (const int energy_ev : {2000, 5000, 10000}) {
      const double formula = std::stod(row.at("S_" + std::to_string(energy_ev) + "eV_eV_per_nm"));
      EXPECT_NEAR(losses.stopping_power_ev_per_nm(energy_ev + d.band.filled_ev) / formula, 1, 0.15)
          << name << ", " << energy_ev;
    }
  }
}

TEST(SinglePole, HandsOverNoMomentumThatIsNotThere) {
  const DielectricData d = data_of("Si");
  const SinglePole losses(d.elf, d.band);
  int allowed = 0;
  for (const double energy_ev : {12.0, 25.0, 60.0, 300.0, 2000.0, 20000.0})
    for (double w0_ev = 1.2; w0_ev < energy_ev; w0_ev *= 1.3) {
      const double energy = energy_ev / hartree_ev, w0 = w0_ev / hartree_ev;
      const SinglePole::Momenta m = losses.momenta(energy, w0);
      if (!(m.last > m.first)) continue;
      ++allowed;
      const auto momentum = [](double t) { return std::sqrt(2 * t * (1 + t / (2 * 18778.865))); };
      for (const double q : {m.first, std::sqrt(m.first * m.last), m.last}) {
        const double loss = SinglePole::loss(w0, q), after = momentum(energy - loss);
        EXPECT_GE(loss, w0);
        EXPECT_LE(loss, energy - (d.band.filled_ev + d.band.gap_ev) / hartree_ev + 1e-9);
        EXPECT_GE(q, momentum(energy) - after - 1e-9);
        EXPECT_LE(q, momentum(energy) + after + 1e-9);
      }
    }
  EXPECT_GT(allowed, 50);
}

TEST(SinglePole, LosesNothingWhereNoStateIsFree) {
  const DielectricData silicon = data_of("Si"), oxide = data_of("SiO2");
  const SinglePole in_silicon(silicon.elf, silicon.band), in_oxide(oxide.elf, oxide.band);
  EXPECT_EQ(in_silicon.inverse_mean_free_path_per_nm(silicon.band.filled_ev +
                                                     2 * silicon.band.gap_ev - 0.01),
            0);
  EXPECT_GT(in_silicon.inverse_mean_free_path_per_nm(30), 0);
  EXPECT_EQ(in_oxide.inverse_mean_free_path_per_nm(oxide.band.filled_ev + 17.9),
            0);  // a gap above the conduction band's bottom
  EXPECT_EQ(in_oxide.stopping_power_ev_per_nm(oxide.band.filled_ev + 17.9), 0);
  EXPECT_GT(in_oxide.inverse_mean_free_path_per_nm(oxide.band.filled_ev + 60), 0);
}

// Silicon, 20 eV above the bottom of the band: with the gap alone forbidden, not the filled band,
// it would be 3.8 nm.
TEST(SinglePole, KeepsLossesOutOfTheFilledBand) {
  const DielectricData d = data_of("Si");
  EXPECT_NEAR(1 / SinglePole(d.elf, d.band).inverse_mean_free_path_per_nm(20), 8.2, 0.8);
}

}  // namespace
}  // namespace surf::mc
