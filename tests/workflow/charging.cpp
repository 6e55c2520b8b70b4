// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/charging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/io/sim/materials.h"

namespace surf::workflow {
namespace {

mc::SimulationResult counted(std::int64_t leaving) {
  mc::SimulationResult r;
  r.balance.incident = 1100;
  r.balance.missed = 100;
  r.balance.se = leaving - 50;
  r.balance.bse = 50;
  r.balance.transmitted = 100;  // those that missed
  r.budget = mc::dose_of_probe(10, 1);
  return r;
}

mc::Scan scan() {
  mc::Scan s;
  s.pixel_x_nm = s.pixel_y_nm = 2;
  return s;
}

std::vector<mc::Material> materials(std::initializer_list<const char*> names) {
  std::vector<mc::Material> out;
  for (const char* name : names) out.push_back(io::find_material(name, "test"));
  return out;
}

TEST(Charging, SaysInWhichSenseAndHowFast) {
  const auto c = charging_of(materials({"SiO2"}), counted(1400), scan());
  ASSERT_TRUE(c);
  EXPECT_DOUBLE_EQ(c->leaving, 1.4);
  EXPECT_NEAR(c->per_nm2, 10e-12 * 1e-6 / 1.602176634e-19 * 0.4 / 4, 1e-6);
  EXPECT_THAT(describe(*c), testing::AllOf(testing::HasSubstr("SiO2 insulates: 1.400 electrons"),
                                           testing::HasSubstr("positive charge"),
                                           testing::HasSubstr("4 pA of 10 pA")));
  EXPECT_THAT(describe(*charging_of(materials({"PMMA", "Si"}), counted(700), scan())),
              testing::AllOf(testing::HasSubstr("PMMA insulates among the materials"),
                             testing::HasSubstr("negative charge stays, 0.300")));
  EXPECT_THAT(describe(*charging_of(materials({"PMMA", "SiO2"}), counted(1001), scan())),
              testing::HasSubstr("hardly any"));
}

TEST(Charging, SaysNothingOfConductors) {
  EXPECT_FALSE(charging_of(materials({"Si", "Au", "Ge"}), counted(1400), scan()));
  EXPECT_FALSE(charging_of(materials({"SiO2"}), mc::SimulationResult{}, scan()));
}

}  // namespace
}  // namespace surf::workflow
