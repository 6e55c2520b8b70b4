// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/all_within.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace surf {
namespace {

TEST(AllWithin, SeesTheOneThatIsNot) {
  using Limits = std::numeric_limits<double>;
  for (const double most : {5.0, 1e12, Limits::max()}) {
    std::vector<double> values{0, -0.0, most, -most, Limits::denorm_min(), -1, 1e-300};
    EXPECT_TRUE(all_within(values, most));
    for (double& value : values) {
      const double kept = value;
      for (const double beyond :
           {std::nextafter(most, 2 * most), Limits::infinity(), Limits::quiet_NaN()})
        for (const double sign : {1.0, -1.0}) {
          value = sign * beyond;
          EXPECT_FALSE(all_within(values, most)) << value;
        }
      value = kept;
    }
  }
  EXPECT_TRUE(all_within({}, 1));
}

}  // namespace
}  // namespace surf
