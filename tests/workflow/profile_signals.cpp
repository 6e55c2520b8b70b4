// SPDX-License-Identifier: GPL-3.0-or-later
#include "profile_signals.h"

#include <gtest/gtest.h>

namespace surf::workflow {
namespace {

const ProfileBox first_of_all{{90, 100, 87, 4, 4}, {8, 40, 7, 4, 4}};

ProfileFit fit_at(const ProfileNumbers& numbers, double height_error_nm = 2) {
  ProfileFit fit;
  for (std::size_t k = 0; k < profile_numbers; ++k) fit.left[k] = {numbers[k], 0.1};
  fit.left[profile_height].standard_error = height_error_nm;
  fit.right = fit.left;
  return fit;
}

TEST(ProfileSignals, AFitLeavesItsBoxWhereTheFirstBoxGoesOn) {
  const ProfileBox box{{90, 100, 87, 4, 4}, {4, 10, 2, 4, 4}};
  EXPECT_FALSE(leaves(fit_at({90, 104, 87, 4, 4}), box, first_of_all, 0.5));
  EXPECT_TRUE(leaves(fit_at({90, 106, 87, 4, 4}), box, first_of_all, 0.5));
  EXPECT_TRUE(leaves(fit_at({90, 94, 87, 4, 4}), box, first_of_all, 0.5));
  EXPECT_FALSE(leaves(fit_at({90, 106, 87, 4, 4}), box, first_of_all, 0.8));
  EXPECT_FALSE(leaves(fit_at({90, 106, 87, 4, 4}, 7), box, first_of_all, 0.5));  // as it may be
  EXPECT_FALSE(leaves(fit_at({90, 100, 87, 0, 8}), box, first_of_all, 0.5));     // nothing beyond
  ProfileFit apart = fit_at(box.middle);
  apart.right[profile_angle].value = 88.5;
  EXPECT_TRUE(leaves(apart, box, first_of_all, 0.5));
}

TEST(ProfileSignals, ABoxThatANumberLeftIsNotMadeSmaller) {
  const ProfileBox box{{90, 100, 87, 4, 4}, {4, 20, 3.5, 4, 4}};
  const ProfileBox next = next_box(box, first_of_all, fit_at({90, 125, 87, 4, 4}));
  EXPECT_EQ(next.middle[profile_height], 125);
  EXPECT_EQ(next.half[profile_height], 20);
  EXPECT_LT(next.half[profile_angle], 2);
}

}  // namespace
}  // namespace surf::workflow
