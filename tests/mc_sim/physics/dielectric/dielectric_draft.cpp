// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/dielectric_draft.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::mc {
namespace {

bool is_estimated(const DielectricData& d, const std::string& field) {
  for (const EstimatedValue& e : d.estimates)
    if (e.field == field) return true;
  return false;
}

// The estimate counts all electrons and has the mean ionization energy of the elements, whatever
// the material.
TEST(DielectricDraft, EstimatesALossFunctionByItsSums) {
  for (const char* name : {"Si", "Au", "PMMA", "TiO2", "W"}) {
    const Material& m = io::find_material(name, "test");
    const EnergyLossFunction elf = estimated_energy_loss_function(m);
    double z = 0;
    for (const Constituent& c : m.constituents) z += c.atomic_number * atoms_per_formula_unit(m, c);
    EXPECT_NEAR(elf.electron_sum(formula_units_per_nm3(m)) / z, 1, 0.06) << name;
    EXPECT_EQ(elf.source(), "estimated");
  }
}

// How good it is: the free paths of the materials whose function was measured.
TEST(DielectricDraft, EstimatesFreePathsWithinSixtyPercent) {
  for (const Material& m : io::builtin_materials()) {
    const DielectricData& d = *m.dielectric;
    const SinglePole measured(d.elf, d.band), estimated(estimated_energy_loss_function(m), d.band);
    for (const double energy_ev : {200.0, 1000.0, 5000.0}) {
      const double ratio = estimated.inverse_mean_free_path_per_nm(d.band.filled_ev + energy_ev) /
                           measured.inverse_mean_free_path_per_nm(d.band.filled_ev + energy_ev);
      EXPECT_GT(ratio, 1 / 1.6) << m.name << ", " << energy_ev;
      EXPECT_LT(ratio, 1.6) << m.name << ", " << energy_ev;
    }
  }
}

TEST(DielectricDraft, MarksWhatItEstimates) {
  const Material& si = io::find_material("Si", "test");
  const auto estimated = complete(DielectricDraft{}, si);
  for (const char* field :
       {"energy_loss_function", "filled_band_ev", "lattice_nm", "sound_m_s", "deformation_ev"})
    EXPECT_TRUE(is_estimated(*estimated, field)) << field;
  EXPECT_FALSE(is_estimated(*estimated, "optical_phonons")) << "not of an element";
  EXPECT_NEAR(estimated->band.gap_ev, 1.1, 1e-9);
  EXPECT_TRUE(si.dielectric->estimates.empty());
  EXPECT_TRUE(is_estimated(*complete(DielectricDraft{}, io::find_material("TiO2", "test")),
                           "optical_phonons"));
}

TEST(DielectricDraft, TakesAMetalsBandFromItsBarrier) {
  const Material& cu = io::find_material("Cu", "test");
  EXPECT_NEAR(complete(DielectricDraft{}, cu)->band.filled_ev, 8.7, 1e-9);
}

TEST(DielectricDraft, RefusesWhatCannotBe) {
  const Material& si = io::find_material("Si", "test");
  DielectricDraft d;
  d.filled_band_ev = 0.1;
  EXPECT_THROW(complete(d, si), InvalidInput);
  d = {};
  d.vacuum_ev = 0.5;  // in the gap
  EXPECT_THROW(complete(d, si), InvalidInput);
  d = {};
  d.optical = std::vector<OpticalMode>{{0.1, 5, 3}};
  EXPECT_THROW(complete(d, si), InvalidInput);
  d = {};
  d.lattice_nm = std::nan("");
  EXPECT_THROW(complete(d, si), InvalidInput);
}

}  // namespace
}  // namespace surf::mc
