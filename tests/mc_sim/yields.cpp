// SPDX-License-Identifier: GPL-3.0-or-later
// Yields of flat silicon and gold against an independent simulation and against measurements.
#include <algorithm>
#include <cmath>
#include <map>

#include "csv.h"
#include "specimens.h"
#include "statistics.h"

namespace surf::mc {

namespace {

Physics plain() {
  Physics p;
  parse_physics("secondaries=off,barrier=off", p);
  return p;
}

// Measured values of an element by energy in eV, neighbours within 3 % together.
std::map<double, std::vector<double>> measured(const char* file, const char* element,
                                               const char* column, double low_ev, double high_ev) {
  std::map<double, std::vector<double>> out;
  for (const auto& row : test::read_reference(file)) {
    const double e = 1000 * test::number(row, "energy_keV");
    if (row.at("element") != element || e < low_ev || e > high_ev) continue;
    auto at = out.lower_bound(e / 1.03);
    if (at == out.end() || at->first > e * 1.03) at = out.emplace(e, std::vector<double>()).first;
    at->second.push_back(test::number(row, column));
  }
  return out;
}

double geometric_mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += std::log(x);
  return std::exp(sum / static_cast<double>(v.size()));
}

}  // namespace

// The reference's settings: Mott, MONSEL's k, no secondaries, no barrier, tracking to 50 eV.
TEST(BackscatterYield, AgreesWithAnIndependentSimulation) {
  int compared = 0;
  for (const auto& row : test::read_reference("eta_single_scattering_si_au.csv")) {
    if (row.at("mott") != "1") continue;
    const char* name = row.at("Z") == "14" ? "Si" : "Au";
    const double energy = 1000 * test::number(row, "E_keV"), tilt = test::number(row, "tilt_deg");
    const auto y = test::flat_yields(name, energy, tilt, 20000, plain());
    EXPECT_NEAR(y.bse.mean, test::number(row, "eta"), 0.015)
        << name << " at " << energy << " eV, " << tilt << " degrees";
    ++compared;
  }
  EXPECT_EQ(compared, 44);
}

TEST(BackscatterYield, OfBrowningAgreesWithTheSameReference) {
  Physics p = plain();
  p.elastic = ElasticModel::browning;
  for (const auto& row : test::read_reference("eta_single_scattering_si_au.csv")) {
    const double energy = 1000 * test::number(row, "E_keV");
    if (row.at("mott") != "0" || energy > 5000) continue;
    const char* name = row.at("Z") == "14" ? "Si" : "Au";
    EXPECT_NEAR(test::flat_yields(name, energy, 0, 20000, p).bse.mean, test::number(row, "eta"), 0.015)
        << name << " at " << energy << " eV";
  }
}

// Every energy that was measured is judged; the spread is that of all measurements within 25 % of it
// in energy, over which eta itself changes little: many energies have a single experiment.
TEST(BackscatterYield, OfTheFullModelIsWithinTheMeasurements) {
  for (const char* name : {"Si", "Au"}) {
    const auto all = measured("bse_eta_joy2001.csv", name, "eta", 300, 30000);
    for (const auto& [energy, own] : all) {
      if (energy < 490 || energy > 20500) continue;
      double low = HUGE_VAL, high = 0;
      for (const auto& [e, values] : all) {
        if (e < energy / 1.25 || e > energy * 1.25) continue;
        for (const double v : values) {
          low = std::min(low, v);
          high = std::max(high, v);
        }
      }
      const auto y = test::flat_yields(name, energy, 0, 10000);
      const double noise = test::z_limit(200) * y.bse.standard_error;
      EXPECT_GT(y.bse.mean + noise, 0.9 * low) << name << " at " << energy << " eV";
      EXPECT_LT(y.bse.mean - noise, 1.1 * high) << name << " at " << energy << " eV";
    }
  }
}

TEST(SecondaryYield, OfSiliconIsWithinAFactorOfTwoOfTheMeasurements) {
  double last = 1e9;
  for (const auto& [energy, values] :
       measured("se_delta_joy2001.csv", "Si", "delta", 490, 10100)) {
    const auto y = test::flat_yields("Si", energy, 0, 40000);
    const double mean = geometric_mean(values);
    EXPECT_GT(y.se.mean, mean / 2) << energy;
    EXPECT_LT(y.se.mean, mean * 2) << energy;
    EXPECT_LT(y.se.mean, last) << "it falls with energy";
    last = y.se.mean;
  }
}

// E_b is fitted at 1 keV: data/materials.toml and bench/fit_loss_join.cpp must not drift apart.
TEST(SecondaryYield, HitsTheMeasurementsItWasFittedTo) {
  for (const char* name : {"Si", "Al", "Cu", "Au"}) {
    const auto values = measured("se_delta_joy2001.csv", name, "delta", 975, 1025);
    ASSERT_EQ(values.size(), 1u);
    const auto y = test::flat_yields(name, 1000, 0, 40000);
    test::expect_mean(y.se.mean, y.se.standard_error, geometric_mean(values.begin()->second), 4,
                      0.02 * y.se.mean);
  }
}

// delta(t) cos(t) is constant at energies whose range is far beyond the escape depth.
TEST(SecondaryYield, RisesLikeOneOverCosineAt5keV) {
  const double flat = test::flat_yields("Si", 5000, 0, 60000).se.mean;
  for (const double tilt : {30.0, 45.0, 60.0}) {
    const double y = test::flat_yields("Si", 5000, tilt, 40000).se.mean;
    EXPECT_NEAR(y * std::cos(tilt * M_PI / 180) / flat, 1, 0.2) << tilt;
  }
}

}  // namespace surf::mc
