// SPDX-License-Identifier: GPL-3.0-or-later
// What the mechanisms make of materials of several elements.
#include <array>
#include <cmath>

#include "physics/mechanism_test.h"
#include "surf/core/error.h"
#include "surf/mc/physics/material_draft.h"

namespace surf::mc {
namespace {

// Silicon dioxide as if it were one element of its weight and all its electrons.
Material as_one_element(const Material& m) {
  Material one = m;
  one.constituents = {{14, m.formula_weight_g_mol, 1.0, 100}};
  return one;
}

// 602.2 x 2.2 / 60.083 = 22.05 formula units and 352.8 valence electrons per nm^3.
TEST(Compound, HasItsValenceElectronsPerFormulaUnit) {
  const Material& m = material("SiO2");
  EXPECT_NEAR(formula_units_per_nm3(m), 22.05, 0.01);
  EXPECT_NEAR(number_density_per_nm3(m, m.constituents[0]), 22.05, 0.01);
  EXPECT_NEAR(number_density_per_nm3(m, m.constituents[1]), 44.10, 0.02);
  const auto compound = make_moller(m, {}), element = make_moller(as_one_element(m), {});
  EXPECT_THAT(compound->describe(), testing::HasSubstr("with 352.8 valence electrons per nm^3"));
  for (const double energy : {30.0, 100.0, 1000.0, 20000.0}) {
    EXPECT_NEAR(compound->inverse_mean_free_path_per_nm(energy),
                element->inverse_mean_free_path_per_nm(energy),
                1e-12 * element->inverse_mean_free_path_per_nm(energy));
    EXPECT_GT(compound->inverse_mean_free_path_per_nm(energy), 0);
  }
}

TEST(Compound, HasThePlasmonOfItsElectronDensity) {
  for (const char* name : {"SiO2", "TiO2", "PMMA"}) {
    const Material& m = material(name);
    const double free =
        28.816 * std::sqrt(m.valence_electrons * m.density_g_cm3 / m.formula_weight_g_mol);
    EXPECT_NEAR(m.plasmon_ev, free, 0.01) << name;
  }
}

// Each element with its own J, by weight; a mean J would be off by 1 % and more.
TEST(Compound, LosesEnergyAsTheSumOfItsElements) {
  Material m = material("TiO2");
  Physics plain;
  plain.secondaries = false;
  const auto compound = make_joy_luo(m, plain);
  for (const double energy : {100.0, 1000.0, 20000.0}) {
    double sum = 0, z_a = 0, ln_j = 0;
    for (const Constituent& c : m.constituents) {
      Material pure = m;
      pure.constituents = {c};
      pure.constituents[0].weight_fraction = 1;
      sum += c.weight_fraction * make_joy_luo(pure, plain)->stopping_power_ev_per_nm(energy);
      z_a += c.weight_fraction * c.atomic_number / c.atomic_weight;
      ln_j +=
          c.weight_fraction * c.atomic_number / c.atomic_weight * std::log(c.mean_ionization_ev);
    }
    const double power = compound->stopping_power_ev_per_nm(energy);
    EXPECT_NEAR(power, sum, 1e-12 * sum);
    const double mean_j = std::exp(ln_j / z_a);
    const double of_mean = 7850 * m.density_g_cm3 / energy * z_a *
                           std::log(1.166 * (energy - m.barrier_ev - 1) / mean_j + 1);
    if (energy < 200) {
      EXPECT_GT(std::fabs(of_mean / power - 1), 0.01);
    }
  }
}

// PMMA at 1 keV: C, H and O are hit in proportion to their number times their cross-section.
TEST(Compound, IsScatteredByItsElementsByTheirShare) {
  const Material& m = material("PMMA");
  Physics plain;
  plain.secondaries = false;
  const Medium medium = make_medium(m, plain);
  constexpr double energy = 1000;
  std::vector<double> expected;
  double total = 0;
  for (const Constituent& c : m.constituents) {
    const auto mott = make_mott(m, c);
    double rate = 0;  // of the energy bin, as the medium takes it
    const double low = EnergyBins::lower_ev(EnergyBins::bin(energy));
    const double high = EnergyBins::lower_ev(EnergyBins::bin(energy) + 1);
    for (int i = 0; i < 8; ++i)
      rate += mott->inverse_mean_free_path_per_nm(low + (i + 0.5) / 8 * (high - low)) / 8;
    expected.push_back(rate);
    total += rate;
  }
  constexpr int n = 100000;
  for (double& e : expected) e *= n / total;
  std::vector<std::int64_t> counts(expected.size());
  RandomStream random(1, 0, 0);
  for (int i = 0; i < n; ++i) {
    const std::string text = medium.choose(energy, random.uniform()).describe();
    for (std::size_t k = 0; k < counts.size(); ++k)
      if (text.find("Z = " + std::to_string(m.constituents[k].atomic_number) + ":") !=
          std::string::npos)
        ++counts[k];
  }
  test::expect_distributed(counts, expected);
}

TEST(Compound, WithoutATableIsRefusedWithAWayOut) {
  MaterialDraft draft;
  draft.name = "GaAs";
  draft.formula = parse_formula("GaAs", "test");
  draft.density_g_cm3 = 5.32;
  draft.band_gap_ev = 1.42;
  const Material m = complete(draft);
  try {
    make_medium(m, {});
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("no Mott table for Ga (Z = 31)"),
                                             testing::HasSubstr("H, C, N, O, Al, Si"),
                                             testing::HasSubstr("elastic=browning")));
  }
  Physics browning;
  browning.elastic = ElasticModel::browning;
  EXPECT_NO_THROW(make_medium(m, browning));
}

// The regression has two coefficients for seven materials with barriers of 0.5 to 25.4 eV. A yield
// goes about as E_b^2.2, so 3 % are 7 % of the yield.
TEST(Compound, EstimatedJoinIsNearEveryFittedOne) {
  int fitted = 0;
  for (const Material& m : io::builtin_materials()) {
    if (!m.loss_join_fitted) continue;
    ++fitted;
    EXPECT_NEAR(estimated_loss_join_ev(m.barrier_ev, m.work_function_ev) / m.loss_join_ev, 1, 0.03)
        << m.name;
  }
  EXPECT_EQ(fitted, 7);
}

}  // namespace
}  // namespace surf::mc
