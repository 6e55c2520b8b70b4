// SPDX-License-Identifier: GPL-3.0-or-later
// Yields by losses in events, against other programs and measurements. Nothing was fitted to them:
// docs/explanation/dielectric.md.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "csv.h"
#include "specimens.h"
#include "statistics.h"

namespace surf::mc {
namespace {

Physics in_events(const char* more = "") {
  Physics physics;
  parse_physics(std::string("inelastic=dielectric,") + more, physics);
  return physics;
}

test::Yields flat_yields(const char* name, double energy_ev, double tilt_deg, int primaries) {
  return test::flat_yields(name, energy_ev, tilt_deg, primaries, in_events());
}

// SE of silicon: between nine tenths of the smaller and eleven tenths of the larger of two programs
// that do the same by full Penn, Nebula 1.0.2 and JMONSEL.
TEST(DielectricYield, OfSiliconLiesBetweenThatOfOtherPrograms) {
  struct Row {
    double energy_ev, nebula, jmonsel;
  };
  constexpr Row rows[] = {{500, 0.5462, 0.443},
                          {1000, 0.3575, 0.294},
                          {2000, 0.1963, 0.165},
                          {5000, 0.0892, 0.072},
                          {10000, 0.0440, 0.040}};
  for (const Row& row : rows) {
    const auto y = flat_yields("Si", row.energy_ev, 0, row.energy_ev > 3000 ? 6000 : 12000);
    const double noise = 4 * std::hypot(y.se.standard_error, 0.003);
    EXPECT_GT(y.se.mean + noise, 0.9 * std::min(row.nebula, row.jmonsel)) << row.energy_ev;
    EXPECT_LT(y.se.mean - noise, 1.1 * std::max(row.nebula, row.jmonsel)) << row.energy_ev;
  }
}

TEST(DielectricYield, OfSiliconRisesWithTiltAsInNebula) {
  const double flat = flat_yields("Si", 1000, 0, 30000).se.mean;
  for (const auto& [tilt, nebula] :
       {std::pair{30, 0.4027}, {45, 0.4881}, {60, 0.6558}, {75, 0.8788}}) {
    const auto y = flat_yields("Si", 1000, tilt, 12000);
    EXPECT_NEAR(y.se.mean / flat / (nebula / 0.3575), 1, 0.1) << tilt;
  }
}

// Within 15 % of JMONSEL's.
TEST(DielectricYield, BackscatteredOfSiliconAgreesWithJmonsel) {
  for (const auto& [energy_ev, jmonsel] : {std::pair{500.0, 0.251},
                                           {1000.0, 0.251},
                                           {2000.0, 0.235},
                                           {5000.0, 0.200},
                                           {10000.0, 0.182}}) {
    const auto y = flat_yields("Si", energy_ev, 0, energy_ev > 3000 ? 6000 : 12000);
    EXPECT_NEAR(y.bse.mean / jmonsel, 1, 0.15 + 4 * y.bse.standard_error / jmonsel) << energy_ev;
  }
}

// Measurements of one energy differ by factors: their span, widened by 1.3. Joy's compilation.
TEST(DielectricYield, OfMetalsLiesAmongTheMeasurements) {
  for (const char* const name : {"Al", "Cu", "Au"}) {
    std::map<std::string, std::map<double, double>> sets;
    for (const auto& row : test::read_reference("se_delta_joy2001.csv"))
      if (row.at("element") == name)
        sets[row.at("set")][1000 * test::number(row, "energy_keV")] = test::number(row, "delta");
    for (const double energy_ev : {800.0, 1000.0, 2000.0}) {
      double low = HUGE_VAL, high = 0;
      for (const auto& [set, points] : sets)
        for (const auto& [at, delta] : points)
          if (std::fabs(std::log(at / energy_ev)) < std::log(1.26))
            low = std::min(low, delta), high = std::max(high, delta);
      const auto y = flat_yields(name, energy_ev, 0, 6000);
      EXPECT_GT(y.se.mean + 4 * y.se.standard_error, low / 1.3) << name << ", " << energy_ev;
      EXPECT_LT(y.se.mean - 4 * y.se.standard_error, high * 1.3) << name << ", " << energy_ev;
    }
  }
}

// One set of each metal goes through a maximum, Bronstein and Fraiman's of clean surfaces; the
// order of metals is theirs.
TEST(DielectricYield, OfMetalsHasTheMaximaOfCleanSurfaces) {
  double last = 0;
  for (const auto& [name, measured] : {std::pair{"Al", 0.642}, {"Cu", 1.034}, {"Au", 1.395}}) {
    double most = 0;
    for (const double energy_ev : {200.0, 300.0, 500.0, 800.0, 1200.0})
      most = std::max(most, flat_yields(name, energy_ev, 0, 5000).se.mean);
    EXPECT_GT(most, measured / 1.3) << name;
    EXPECT_LT(most, measured * 1.3) << name;
    const double at_1_kev = flat_yields(name, 1000, 0, 5000).se.mean;
    EXPECT_GT(at_1_kev, last) << name;
    last = at_1_kev;
  }
}

// Energies are counted from the vacuum level: nothing is made or lost, whatever the mechanism.
TEST(DielectricYield, KeepsEnergy) {
  for (const char* const name : {"Si", "SiO2", "Au"}) {
    Beam beam;
    beam.energy_ev = 3000;
    const SimulationResult r = test::simulate(test::flat(name), beam, test::square_scan(10, 1), 500,
                                              in_events("auger=on"));
    const Balance& b = r.balance;
    EXPECT_EQ(b.generated_energy.ev(), 0) << "each event pays";
    EXPECT_NEAR(b.incident_energy.ev(),
                b.escaped_energy.ev() + b.deposited_energy.ev() + b.lost_energy.ev(),
                1e-6 * b.incident_energy.ev());
    EXPECT_GT(b.deposited_energy.ev(), 0.5 * b.incident_energy.ev());
  }
}

}  // namespace
}  // namespace surf::mc
