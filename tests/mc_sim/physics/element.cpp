// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/element.h"

#include <set>
#include <string>

#include "csv.h"
#include "surf/mc/physics/material.h"

#include <gtest/gtest.h>

namespace surf::mc {

TEST(Elements, AreInOrderWithRisingWeightsButForTheKnownPairs) {
  ASSERT_EQ(elements().size(), 92u);
  std::set<std::string> symbols;
  int falling = 0;
  for (int z = 1; z <= 92; ++z) {
    const Element& e = element(z);
    EXPECT_EQ(e.atomic_number, z);
    EXPECT_TRUE(symbols.insert(e.symbol).second) << e.symbol;
    EXPECT_EQ(find_element(e.symbol), &e);
    EXPECT_GT(e.valence_electrons, 0) << e.symbol;
    EXPECT_LE(e.valence_electrons, 12) << e.symbol;
    EXPECT_LE(e.free_electrons, e.valence_electrons) << e.symbol;
    if (z > 1 && e.atomic_weight < element(z - 1).atomic_weight) ++falling;
  }
  // Ar-K, Co-Ni, Te-I, Th-Pa; with the longest-lived isotopes nothing else.
  EXPECT_EQ(falling, 4);
}

// Mendeleev's order: the groups of the periodic table, seen in a few columns.
TEST(Elements, OfAGroupHaveTheSameValence) {
  for (const auto& column : {std::set<int>{6, 14, 32, 50, 82},
                             {8, 16, 34, 52, 84},
                             {29, 47, 79},
                             {24, 42, 74},
                             {11, 19, 37, 55, 87}}) {
    for (const int z : column)
      EXPECT_EQ(element(z).valence_electrons, element(*column.begin()).valence_electrons) << z;
  }
  EXPECT_EQ(element(14).valence_electrons, 4);
  EXPECT_EQ(element(79).valence_electrons, 11);
  EXPECT_EQ(element(79).free_electrons, 1);
  EXPECT_EQ(element(8).valence_electrons, 6);
  EXPECT_EQ(find_element("si"), nullptr);
  EXPECT_EQ(find_element(""), nullptr);
}

TEST(Elements, HaveTheReferencesIonizationEnergies) {
  for (const auto& row : test::read_reference("stopping_joyluo.csv"))
    EXPECT_NEAR(mean_ionization_ev(static_cast<int>(test::number(row, "Z"))),
                test::number(row, "J_used_eV"), 0.051);
}

TEST(Elements, WithMottTablesAreAllThatWereComputed) {
  int tables = 0;
  for (const Element& e : elements()) tables += has_mott_table(e.atomic_number) ? 1 : 0;
  EXPECT_EQ(tables, 21);
  for (const int z : {1, 6, 7, 8, 13, 14, 22, 79}) EXPECT_TRUE(has_mott_table(z)) << z;
}

}  // namespace surf::mc
