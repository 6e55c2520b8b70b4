// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/tier_doubt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace surf::workflow {
namespace {

using testing::HasSubstr;

TEST(TierDoubt, SaysWhenTheCheapTierIsEnough) {
  EXPECT_THAT(*tier_doubt({}, 1, 0.1), HasSubstr("enough for 10 %"));
  EXPECT_THAT(*tier_doubt({}, 1, 0.04),
              testing::AllOf(HasSubstr("enough for topography"), HasSubstr("more than the 4 %")));
  EXPECT_THAT(*tier_doubt({}, 1, 0.01), HasSubstr("topography differs by 2 %"));
  EXPECT_THAT(*tier_doubt({}, 2, 0.1), HasSubstr("contrast between materials may be 30 % off"));
}

TEST(TierDoubt, HasNoneOfTheTierThatPaysForEachLoss) {
  mc::Physics physics;
  mc::parse_physics("inelastic=dielectric", physics);
  EXPECT_FALSE(tier_doubt(physics, 2, 0.01));
}

}  // namespace
}  // namespace surf::workflow
