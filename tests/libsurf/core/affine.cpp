// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/affine.h"

#include <gtest/gtest.h>

#include <limits>

#include "surf/core/error.h"

namespace surf {
namespace {

const Affine some{0.9, 0.2, 30, -0.1, 1.2, -7};

TEST(Affine, InverseLeadsBack) {
  const Point2 there = some({12, -5}), back = inverse(some)(there);
  EXPECT_NEAR(back.x, 12, 1e-12);
  EXPECT_NEAR(back.y, -5, 1e-12);
}

TEST(Affine, InverseRefusesWhatLeadsNowhere) {
  EXPECT_THROW(inverse({1, 2, 0, 2, 4, 0}), InvalidInput);
  for (double Affine::*number :
       {&Affine::xx, &Affine::xy, &Affine::x0, &Affine::yx, &Affine::yy, &Affine::y0})
    for (const double wrong :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Affine map = some;
      map.*number = wrong;
      EXPECT_THROW(inverse(map), InvalidInput);
    }
}

}  // namespace
}  // namespace surf
