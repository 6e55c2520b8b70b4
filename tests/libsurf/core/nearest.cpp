// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/nearest.h"

#include <gtest/gtest.h>

namespace surf {
namespace {

TEST(Nearest, IsTheCandidateOfFewestChangesIfTheyAreFew) {
  EXPECT_EQ(nearest("simulat", {"sample", "simulate", "sweep"}), "simulate");
  EXPECT_EQ(nearest("Sj", {"Au", "Si"}), "Si");
  EXPECT_EQ(nearest("reconstruction", {"reconstruct", "register"}), "reconstruct");  // a third
  EXPECT_EQ(nearest("energy", {"tilt", "spot"}), "");
  EXPECT_EQ(nearest("energy", {}), "");
  EXPECT_EQ(nearest("--tlit", {"--unit", "--tilt"}), "--tilt");  // letters that changed places
}

}  // namespace
}  // namespace surf
