// SPDX-License-Identifier: GPL-3.0-or-later
#include "what_held.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace surf::workflow {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A line: its left wall seen by the SEM image, its right one by both, ground touched by the tip.
Reconstruction line() {
  Reconstruction r;
  r.surface.z_nm = Grid<double>(40, 30);
  r.deviation_nm = Grid<double>(40, 30, 0.2);
  r.data_support = Grid<unsigned char>(40, 30, 1);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      r.surface.z_nm(x, y) = x > 10 && x < 25 ? 5 : 0;
      if (x == 10 || x == 11) r.data_support(x, y) = 2, r.deviation_nm(x, y) = 3;
      if (x == 24 || x == 25) r.data_support(x, y) = y < 12 ? 3 : 0;
    }
  return r;
}

TEST(WhatHeld, NamesTheImageThatHoldsEachSide) {
  EXPECT_THAT(
      what_held(line()),
      ElementsAre(AllOf(StartsWith("gentle ground, 90 %"), HasSubstr("the AFM scan alone (100 %)"),
                        HasSubstr("within 0.200 nm")),
                  AllOf(StartsWith("walls that rise to the right, 5 %"),
                        HasSubstr("the SEM image alone (100 %)"), HasSubstr("within 3.00 nm")),
                  AllOf(StartsWith("walls that rise to the left, 5 %"),
                        HasSubstr("through its neighbours (60 %), by both images "
                                  "(40 %)"))));
}

TEST(WhatHeld, SaysNothingWithoutDeviations) {
  Reconstruction r = line();
  r.deviation_nm = {};
  EXPECT_THAT(what_held(r), IsEmpty());
}

}  // namespace
}  // namespace surf::workflow
