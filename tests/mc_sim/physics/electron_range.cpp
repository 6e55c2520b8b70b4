// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/electron_range.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/io/sim/materials.h"

namespace surf::mc {
namespace {

TEST(ElectronRange, IsKanayaAndOkayamas) {
  const Material& silicon = io::find_material("Si", "test");
  const Material& gold = io::find_material("Au", "test");
  EXPECT_NEAR(kanaya_okayama_range_nm(silicon, 1000), 32, 0.5);
  // 27.6 * 196.97 * 20^1.67 / (79^0.89 * 19.3)
  EXPECT_NEAR(kanaya_okayama_range_nm(gold, 20000), 858, 2);
  EXPECT_NEAR(kanaya_okayama_range_nm(silicon, 2000) / kanaya_okayama_range_nm(silicon, 1000),
              std::pow(2, 1.67), 1e-9);
}

TEST(ElectronRange, TakesMeansOverTheAtomsOfACompound) {
  const Material& oxide = io::find_material("SiO2", "test");
  // One silicon, two oxygen atoms: Z is 10, A is 20.03.
  EXPECT_NEAR(kanaya_okayama_range_nm(oxide, 1000),
              27.6 * 20.03 / (std::pow(10, 0.89) * oxide.density_g_cm3), 0.05);
  Material halves = io::find_material("Si", "test");  // of the same element twice
  halves.constituents.push_back(halves.constituents.front());
  for (Constituent& half : halves.constituents) half.weight_fraction = 0.5;
  EXPECT_NEAR(kanaya_okayama_range_nm(halves, 1000),
              kanaya_okayama_range_nm(io::find_material("Si", "test"), 1000), 1e-9);
}

TEST(ElectronRange, RefusesWhatHasNone) {
  EXPECT_THROW(kanaya_okayama_range_nm(io::find_material("Si", "test"), 0), InvalidInput);
  EXPECT_THROW(kanaya_okayama_range_nm(io::find_material("Si", "test"), NAN), InvalidInput);
  EXPECT_THROW(kanaya_okayama_range_nm({}, 1000), InvalidInput);
}

}  // namespace
}  // namespace surf::mc
