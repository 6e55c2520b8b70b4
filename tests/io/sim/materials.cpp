// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/materials.h"

#include <set>

#include "../io_test.h"

namespace surf::io {
namespace {

using testing::HasSubstr;

TEST(Materials, AreValidAndNamedOnce) {
  std::set<std::string> names;
  for (const mc::Material& material : builtin_materials()) {
    EXPECT_NO_THROW(mc::validate(material));
    EXPECT_TRUE(names.insert(material.name).second) << material.name;
    EXPECT_FALSE(material.sources.empty()) << material.name;
  }
  EXPECT_TRUE(names.count("Si"));
}

TEST(Materials, SiliconIsSilicon) {
  const mc::Material& si = find_material("Si", "--material");
  EXPECT_EQ(si.name, "Si");
  EXPECT_NEAR(si.density_g_cm3, 2.33, 0.01);
  ASSERT_EQ(si.constituents.size(), 1u);
  EXPECT_EQ(si.constituents[0].atomic_number, 14);
  EXPECT_NEAR(si.constituents[0].atomic_weight, 28.086, 0.002);
  EXPECT_EQ(si.constituents[0].weight_fraction, 1);
  EXPECT_GT(si.constituents[0].mean_ionization_ev, 100);
  EXPECT_GT(si.loss_join_ev, si.barrier_ev);
}

TEST(Materials, UnknownNamesAreAnsweredWithTheNearestFirst) {
  EXPECT_THAT(test::complaint<UsageError>([] { find_material("si", "--material"); }),
              testing::AllOf(HasSubstr("--material: "), HasSubstr("'si'"),
                             HasSubstr("Choose one of: Si")));
}

}  // namespace
}  // namespace surf::io
