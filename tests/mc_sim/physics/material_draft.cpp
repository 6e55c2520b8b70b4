// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/material_draft.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"
#include "surf/io/sim/materials.h"

namespace surf::mc {
namespace {

using testing::HasSubstr;

MaterialDraft draft(const char* formula, double density) {
  MaterialDraft d;
  d.name = formula;
  d.formula = parse_formula(formula, "test");
  d.density_g_cm3 = density;
  return d;
}

std::string rule(const Material& m, const std::string& field) {
  for (const EstimatedValue& e : m.estimates)
    if (e.field == field) return e.rule;
  return {};
}

std::string refused(const MaterialDraft& d) {
  try {
    complete(d);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

// By hand: Si3N4, M = 3 x 28.085 + 4 x 14.007 = 140.283 g/mol, 3 x 4 + 4 x 5 = 32 electrons.
TEST(MaterialDraft, OfAnInsulatorIsCompletedByTheStatedRules) {
  MaterialDraft d = draft("Si3N4", 3.17);
  d.band_gap_ev = 5.3;
  const Material m = complete(d);
  EXPECT_NEAR(m.formula_weight_g_mol, 140.283, 1e-9);
  EXPECT_NEAR(m.constituents[0].weight_fraction, 84.255 / 140.283, 1e-12);
  EXPECT_NEAR(atoms_per_formula_unit(m, m.constituents[1]), 4, 1e-12);
  EXPECT_NEAR(formula_units_per_nm3(m), 602.214076 * 3.17 / 140.283, 1e-9);
  EXPECT_EQ(m.valence_electrons, 32);
  EXPECT_NEAR(m.plasmon_ev, 28.816 * std::sqrt(32 * 3.17 / 140.283), 1e-9);
  EXPECT_DOUBLE_EQ(m.work_function_ev, 6.3);  // a wide gap: affinity 1 eV
  EXPECT_DOUBLE_EQ(m.barrier_ev, 1.0);
  EXPECT_EQ(m.loss_join_ev, estimated_loss_join_ev(1.0, 6.3));
  EXPECT_FALSE(m.loss_join_fitted);
  EXPECT_EQ(m.estimates.size(), 5u);
  EXPECT_THAT(rule(m, "work_function_ev"), HasSubstr("affinity of 1 eV"));
  d.band_gap_ev = 1.42;
  EXPECT_DOUBLE_EQ(complete(d).barrier_ev, 4.0);
}

TEST(MaterialDraft, KeepsWhatIsGivenAndListsNothingThen) {
  MaterialDraft d = draft("SiO2", 2.2);
  d.work_function_ev = 10;
  d.barrier_ev = 1.1;
  d.valence_electrons = 15;
  d.plasmon_ev = 0;
  d.loss_join_ev = 13;
  d.loss_join_fitted = true;
  d.sources = "here";
  const Material m = complete(d);
  EXPECT_TRUE(m.estimates.empty());
  EXPECT_EQ(m.work_function_ev, 10);
  EXPECT_EQ(m.barrier_ev, 1.1);
  EXPECT_EQ(m.valence_electrons, 15);
  EXPECT_EQ(m.plasmon_ev, 0);
  EXPECT_EQ(m.loss_join_ev, 13);
  EXPECT_TRUE(m.loss_join_fitted);
  EXPECT_EQ(m.sources, "here");
}

TEST(MaterialDraft, TakesTheThirdOfGapBarrierAndWorkFunctionFromTheOtherTwo) {
  MaterialDraft d = draft("SiO2", 2.2);
  d.band_gap_ev = 8.9;
  d.barrier_ev = 1.1;
  EXPECT_DOUBLE_EQ(complete(d).work_function_ev, 10.0);
  EXPECT_EQ(rule(complete(d), "work_function_ev"), "") << "it follows";
  d.barrier_ev.reset();
  d.work_function_ev = 10;
  EXPECT_NEAR(complete(d).barrier_ev, 1.1, 1e-12);
  EXPECT_EQ(rule(complete(d), "barrier_ev"), "") << "it follows";
  d.barrier_ev = 1.2;
  EXPECT_THAT(refused(d), HasSubstr("barrier_ev 1.2 is not the work function 10 less"));
}

// A free-electron gas by hand: vanadium, 2 free electrons in 50.942 g/mol at 6.11 g/cm^3:
// n = 144.5 / nm^3, E_F = hbar^2 (3 pi^2 n)^(2/3) / 2 m = 0.0380998 eV nm^2 x (3 pi^2 n)^(2/3).
TEST(MaterialDraft, OfAMetalHasTheFermiEnergyOfItsFreeElectrons) {
  const Material m = complete(draft("V", 6.11));
  const double n = 2 * formula_units_per_nm3(m);
  const double fermi = 0.0380998 * std::pow(3 * M_PI * M_PI * n, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(m.work_function_ev, 4.5);
  EXPECT_NEAR(m.barrier_ev, 4.5 + fermi, 2e-3 * fermi);
  EXPECT_THAT(rule(m, "barrier_ev"), HasSubstr("give band_gap_ev if it is none"));
}

TEST(MaterialDraft, OfKnownElementsLiesBetweenThem) {
  const auto& known = io::builtin_materials();
  const Material m = complete(draft("Cu3Au", 12.2), known);
  const Material& cu = io::find_material("Cu", "test");
  const Material& au = io::find_material("Au", "test");
  EXPECT_NEAR(m.work_function_ev, 0.75 * cu.work_function_ev + 0.25 * au.work_function_ev, 1e-9);
  EXPECT_NEAR(m.barrier_ev, 0.75 * cu.barrier_ev + 0.25 * au.barrier_ev, 1e-9);
  EXPECT_DOUBLE_EQ(complete(draft("Cu3Au", 12.2)).work_function_ev, 4.5);
  // A pure element of other density is the element.
  EXPECT_DOUBLE_EQ(complete(draft("Au", 10), known).barrier_ev, au.barrier_ev);
}

TEST(MaterialDraft, TakesElementsByWeight) {
  MaterialDraft d;
  d.name = "brass";
  d.density_g_cm3 = 8.5;
  d.constituents = {{29, 0, 0.63, 0}, {30, 65.4, 0.37, 330}};
  const Material m = complete(d);
  EXPECT_EQ(m.constituents[0].atomic_weight, 63.546);
  EXPECT_NEAR(m.constituents[0].mean_ionization_ev, 9.76 * 29 + 58.8 * std::pow(29, -0.19), 1e-9);
  EXPECT_EQ(m.constituents[1].atomic_weight, 65.4);
  EXPECT_EQ(m.constituents[1].mean_ionization_ev, 330);
  EXPECT_NEAR(
      atoms_per_formula_unit(m, m.constituents[0]) + atoms_per_formula_unit(m, m.constituents[1]),
      1, 1e-12);
  EXPECT_NEAR(m.valence_electrons, 11 + atoms_per_formula_unit(m, m.constituents[1]), 1e-12);
}

TEST(MaterialDraft, RefusesWhatCannotBe) {
  EXPECT_THAT(refused(draft("Si", 0)), HasSubstr("density_g_cm3 is 0"));
  EXPECT_THAT(refused(draft("Si", -1)), HasSubstr("density_g_cm3 is -1"));
  EXPECT_THAT(refused(draft("Si", std::nan(""))), HasSubstr("density_g_cm3 is nan"));
  MaterialDraft d = draft("SiO2", 2.2);
  d.band_gap_ev = -1;
  EXPECT_THAT(refused(d), HasSubstr("band_gap_ev is -1"));
  d.band_gap_ev = 8.9;
  d.work_function_ev = 5;
  EXPECT_THAT(refused(d), HasSubstr("wider than the work function"));
  d = draft("SiO2", 2.2);
  d.valence_electrons = -1;
  EXPECT_THAT(refused(d), HasSubstr("valence_electrons is -1"));
  d = {};
  d.name = "empty";
  d.density_g_cm3 = 1;
  EXPECT_THAT(refused(d), HasSubstr("no elements"));
  d.constituents = {{93, 0, 1, 0}};
  EXPECT_THAT(refused(d), HasSubstr("no element 93"));
  d.constituents = {{29, 0, 63, 0}, {30, 0, 37, 0}};
  EXPECT_THAT(refused(d), HasSubstr("sum of weight fractions is 100"));
  d.constituents = {{29, 0, 1.5, 0}, {30, 0, -0.5, 0}};
  EXPECT_THAT(refused(d), HasSubstr("weight fraction is -0.5"));
}

}  // namespace
}  // namespace surf::mc
