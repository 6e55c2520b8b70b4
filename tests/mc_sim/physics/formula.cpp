// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/formula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

using testing::HasSubstr;

// "Z:atoms Z:atoms"
std::string read(const std::string& text) {
  std::string out;
  for (const FormulaPart& p : parse_formula(text, "formula")) {
    char item[64];
    std::snprintf(item, sizeof item, "%s%d:%g", out.empty() ? "" : " ", p.atomic_number, p.atoms);
    out += item;
  }
  return out;
}

std::string refused(const std::string& text) {
  try {
    read(text);
  } catch (const UsageError& error) {
    EXPECT_EQ(error.subject(), "formula");
    return error.reason();
  }
  ADD_FAILURE() << text << " was accepted";
  return {};
}

TEST(Formula, IsReadWithCountsAndGroups) {
  EXPECT_EQ(read("Si"), "14:1");
  EXPECT_EQ(read("SiO2"), "14:1 8:2");
  EXPECT_EQ(read("C5H8O2"), "6:5 1:8 8:2");
  EXPECT_EQ(read("Si3N4"), "14:3 7:4");
  EXPECT_EQ(read("Al0.3Ga0.7As"), "13:0.3 31:0.7 33:1");
  EXPECT_EQ(read("Ca(OH)2"), "20:1 8:2 1:2");
  EXPECT_EQ(read("K4[Fe(CN)6]"), "19:4 26:1 6:6 7:6");
  EXPECT_EQ(read("{CH3}2.5"), "6:2.5 1:7.5");
}

TEST(Formula, TellsCobaltFromCarbonMonoxideAndAddsUp) {
  EXPECT_EQ(read("Co"), "27:1");
  EXPECT_EQ(read("CO"), "6:1 8:1");
  EXPECT_EQ(read("CH3CH2OH"), "6:2 1:6 8:1");
}

TEST(Formula, IsRefusedWithTheReasonAndThePlace) {
  EXPECT_THAT(refused(""), HasSubstr("empty"));
  EXPECT_THAT(refused("SiXx2"), HasSubstr("no element 'Xx', at letter 3 of 'SiXx2'"));
  EXPECT_THAT(refused("sio2"), HasSubstr("'s' is neither an element nor a bracket, at letter 1"));
  EXPECT_THAT(refused("2SiO"), HasSubstr("'2' is neither"));
  EXPECT_THAT(refused("Ca(OH2"), HasSubstr("')' is missing"));
  EXPECT_THAT(refused("Ca(OH]2"), HasSubstr("')' is missing"));
  EXPECT_THAT(refused("CaOH)2"), HasSubstr("')' closes nothing"));
  EXPECT_THAT(refused("Si()2"), HasSubstr("brackets are empty"));
  EXPECT_THAT(refused("SiO0"), HasSubstr("'0' is not a count"));
  EXPECT_THAT(refused("SiO1.2.3"), HasSubstr("'1.2.3' is not a count"));
  EXPECT_THAT(refused("SiO99999999"), HasSubstr("not a count"));
  EXPECT_THAT(refused("Si O2"), HasSubstr("' ' is neither"));
  EXPECT_THAT(refused("J"), HasSubstr("no element 'J'"));
  EXPECT_THAT(refused(std::string(150, '(') + std::string(150, ')')), HasSubstr("300 letters"));
}

}  // namespace
}  // namespace surf::mc
