// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/material_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/io/sim/materials.h"
#include "surf/mc/physics/material_draft.h"

namespace surf::mc {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

MaterialDraft draft(const char* formula) {
  MaterialDraft d;
  d.name = formula;
  d.formula = parse_formula(formula, "test");
  d.density_g_cm3 = 3;
  return d;
}

const auto taken_for_metal =
    Contains(HasSubstr("taken for a metal, as its band_gap_ev is not given"));

TEST(MaterialDoubts, NameAnInsulatorThatIsTakenForAMetal) {
  for (const char* formula : {"Si3N4", "Al2O3", "MgF2", "NaCl", "ZnS", "GaAs", "C8H8", "C2H4"})
    EXPECT_THAT(doubts(complete(draft(formula))), taken_for_metal) << formula;
  for (const char* formula : {"Cu3Zn2", "CoSi2", "WC", "Ni9P", "C", "TaN"}) {
    MaterialDraft d = draft(formula);
    if (d.name == "TaN") d.band_gap_ev = 0;  // it is one, and its user says so
    EXPECT_THAT(doubts(complete(d)), Not(taken_for_metal)) << formula;
  }
}

TEST(MaterialDoubts, NeedNoGapWhereItFollows) {
  MaterialDraft d = draft("Si3N4");
  d.barrier_ev = 1;
  EXPECT_THAT(doubts(complete(d)), taken_for_metal);  // the work function would be a metal's
  d.work_function_ev = 6.3;
  EXPECT_THAT(doubts(complete(d)), Not(taken_for_metal));
}

TEST(MaterialDoubts, NameTheEstimates) {
  MaterialDraft d = draft("Si3N4");
  d.band_gap_ev = 5.3;
  EXPECT_THAT(
      doubts(complete(d)),
      ElementsAre(HasSubstr(
          "estimates: valence_electrons, plasmon_ev, work_function_ev, barrier_ev. 'semsurf "
          "materials Si3N4'")));
  d.valence_electrons = 32;
  d.plasmon_ev = 24;
  d.barrier_ev = 1;
  d.work_function_ev = 6.3;
  EXPECT_THAT(doubts(complete(d)), IsEmpty());
}

TEST(MaterialDoubts, AreNoneOfWhatComesWithSemsurf) {
  for (const Material& m : io::builtin_materials()) EXPECT_THAT(doubts(m), IsEmpty()) << m.name;
}

}  // namespace
}  // namespace surf::mc
