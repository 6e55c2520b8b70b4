// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/mott_data.h"

#include <cmath>

#include "physics/mechanism_test.h"
#include "surf/core/error.h"

namespace surf::mc {

namespace {

// Fraction of events with mu below a value, from the table that is sampled.
double table_cdf(const MottRow& row, double mu) {
  const double x = (1 + row.a) * mu / (row.a + mu);
  const int n = MottRow::points - 1;
  int i = 0;
  while (i < n - 1 && row.x[i + 1] < x) ++i;
  const double u = (i + (x - row.x[i]) / (row.x[i + 1] - row.x[i])) / n;
  return 1 - (1 - std::clamp(u, 0.0, 1.0)) * (1 - std::clamp(u, 0.0, 1.0));
}

}  // namespace

namespace {

std::vector<MottElement> all_elements() {
  std::vector<MottElement> all(free_mott_elements().begin(), free_mott_elements().end());
  all.insert(all.end(), solid_mott_elements().begin(), solid_mott_elements().end());
  return all;
}

}  // namespace

TEST(Mott, TablesAreDistributions) {
  for (const MottElement& element : all_elements()) {
    double last = 0;
    for (const MottRow& row : element.rows) {
      EXPECT_GT(row.energy_ev, last);
      last = row.energy_ev;
      EXPECT_EQ(row.x[0], 0);
      EXPECT_NEAR(row.x[MottRow::points - 1], 1, 1e-6);
      for (int i = 1; i < MottRow::points; ++i) ASSERT_GE(row.x[i], row.x[i - 1]);
    }
  }
}

// The mean of 1 - cos theta over the sampler, integrated exactly from its inverse distribution.
TEST(Mott, ReproducesTheTransportCrossSections) {
  for (const MottElement& element : all_elements()) {
    for (const MottRow& row : element.rows) {
      double mean = 0;
      const int n = 200000;
      for (int k = 0; k < n; ++k) {
        const double r = (k + 0.5) / n;
        const double u = (1 - std::sqrt(1 - r)) * (MottRow::points - 1);
        const int i = static_cast<int>(u);
        const double x = row.x[i] + (u - i) * (row.x[i + 1] - row.x[i]);
        mean += 2 * row.a * x / (1 + row.a - x) / n;
      }
      EXPECT_NEAR(mean * row.cross_section_nm2 / row.transport_cross_section_nm2, 1, 0.005)
          << "Z " << element.atomic_number << " at " << row.energy_ev << " eV";
    }
  }
}

TEST(Mott, SamplesTheTablesAroundAnEnergy) {
  const Material& gold = material("Au");
  const auto mott = make_mott(gold, gold.constituents[0]);
  const MottElement& element = *find_mott_element(79);
  const double edges[] = {0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  for (const double energy : {60.0, 230.0, 1000.0, 12000.0}) {
    // The mechanism chooses between neighbours by the logarithm of its energy bin's middle.
    const int bin = EnergyBins::bin(energy);
    const double middle = 0.5 * (EnergyBins::lower_ev(bin) + EnergyBins::lower_ev(bin + 1));
    std::size_t i = 0;
    while (element.rows[i + 1].energy_ev <= middle) ++i;
    const MottRow &low = element.rows[i], &high = element.rows[i + 1];
    const double f = std::log(middle / low.energy_ev) / std::log(high.energy_ev / low.energy_ev);
    expect_sampled(
        *mott, energy, 200000, {std::begin(edges), std::end(edges)},
        [](const ScatterEvent& e) { return (1 - e.cos_theta) / 2; },
        [&](double mu) { return (1 - f) * table_cdf(low, mu) + f * table_cdf(high, mu); }, 8);
    std::vector<double> turns;
    for (int k = 1; k < 16; ++k) turns.push_back(k / 16.0);
    expect_sampled(
        *mott, energy, 100000, turns, [](const ScatterEvent& e) { return e.turn; },
        [](double t) { return t; }, 8, 2);
  }
}

TEST(Mott, RateIsDensityTimesCrossSection) {
  const Material& si = material("Si");
  const auto mott = make_mott(si, si.constituents[0]);
  // 1.376e-16 cm^2 at 1 keV (NIST SRD 64) and 2.33 g/cm^3.
  EXPECT_NEAR(mott->inverse_mean_free_path_per_nm(1000), 1.376e-2 * 602.214 * 2.33 / 28.086, 5e-4);
  // Below the lowest table: isotropic, with the transport cross-section of that table's end.
  EXPECT_NEAR(mott->inverse_mean_free_path_per_nm(49.999), 3.7249e-2 * 602.214 * 2.33 / 28.086,
              5e-4);
  EXPECT_GT(mott->inverse_mean_free_path_per_nm(4), 0);
  EXPECT_LT(mott->inverse_mean_free_path_per_nm(4), mott->inverse_mean_free_path_per_nm(49));
  std::vector<double> edges;
  for (int i = 1; i < 10; ++i) edges.push_back(-1 + i / 5.0);
  expect_sampled(
      *mott, 20, 50000, edges, [](const ScatterEvent& e) { return e.cos_theta; },
      [](double c) { return (1 + c) / 2; });
}

// In a solid forward scattering is cut off: the total path is longer, the transport path hardly
// differs.
TEST(Mott, HasTablesOfAtomsInASolid) {
  const Material& si = material("Si");
  const auto free = make_mott(si, si.constituents[0]),
             solid = make_mott(si, si.constituents[0], MottAtoms::solid);
  EXPECT_NEAR(1 / free->inverse_mean_free_path_per_nm(1000), 1.45, 0.02);
  EXPECT_NEAR(1 / solid->inverse_mean_free_path_per_nm(1000), 2.18, 0.05 * 2.18);
  const auto transport_nm = [&](MottAtoms atoms) {
    for (const MottRow& row : find_mott_element(14, atoms)->rows)
      if (row.energy_ev == 1000)
        return 1 /
               (row.transport_cross_section_nm2 * number_density_per_nm3(si, si.constituents[0]));
    return 0.0;
  };
  EXPECT_NEAR(transport_nm(MottAtoms::free), 15, 0.75);
  EXPECT_NEAR(transport_nm(MottAtoms::solid), 15, 0.75);
}

TEST(Mott, SaysWhichElementItLacks) {
  Material odd = material("Si");
  odd.constituents[0].atomic_number = 61;
  try {
    make_mott(odd, odd.constituents[0]);
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("61"));
    EXPECT_THAT(e.what(), testing::HasSubstr("browning"));
  }
}

}  // namespace surf::mc
