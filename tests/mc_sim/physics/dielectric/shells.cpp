// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/shells.h"

#include <gtest/gtest.h>

#include "surf/io/sim/materials.h"

namespace surf::mc {
namespace {

const DielectricData& data_of(const char* name) {
  return *io::find_material(name, "test").dielectric;
}

TEST(Shells, TakeWhatIsAboveTheContinuationFromBelowTheEdge) {
  const Shells silicon(data_of("Si"));
  EXPECT_EQ(silicon.lowest_ev(), 100);
  EXPECT_EQ(silicon.share(99, 99), 0);
  EXPECT_GT(silicon.share(140, 140), 0.8) << "the L shell absorbs most";
  EXPECT_EQ(silicon.draw(140, 140, 0.01), 100);
  EXPECT_EQ(silicon.draw(60, 60, 0), 0);
  EXPECT_GT(silicon.share(1900, 1900), 0.99);
  EXPECT_EQ(silicon.draw(1900, 1900, 0.01), 1839) << "K";
}

TEST(Shells, AreNotIonizedByLessThanTheyTake) {
  const Shells silicon(data_of("Si"));
  EXPECT_EQ(silicon.draw(140, 100.5, 0.01), 0) << "not to the conduction band";
  EXPECT_EQ(silicon.draw_inner(102, 0.5), 100);
}

// Gold's eleven valence electrons have used up their part of the f-sum at 64 eV.
TEST(Shells, AbsorbAloneWhereTheValenceElectronsAreExhausted) {
  const DielectricData& gold = data_of("Au");
  EXPECT_NEAR(gold.exhausted_ev, 64, 2);
  const Shells shells(gold);
  EXPECT_EQ(shells.draw(70, 70, 0.999), 55);
  EXPECT_EQ(shells.draw(60, 60, 0.999), 0);
  EXPECT_EQ(shells.share(70, 70), 1);
}

TEST(Shells, AreFilledFromTheNextOne) {
  const Shells silicon(data_of("Si"));
  EXPECT_EQ(silicon.next_ev(1839), 100);
  EXPECT_EQ(silicon.next_ev(100), 0);
}

}  // namespace
}  // namespace surf::mc
