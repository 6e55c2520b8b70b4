// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/height_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

TEST(HeightProfile, CrossesABoxAtAnyAngle) {
  const TriangleMesh box = make_box({-10, -10, 0}, {10, 10, 5}, 1);
  for (const double angle : {0.0, 0.3, 1.9}) {
    const Point2 from{-30 * std::cos(angle), -30 * std::sin(angle)},
        to{30 * std::cos(angle), 30 * std::sin(angle)};
    const std::vector<double> z = height_profile(box, from, to, 601);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double t = -30 + 0.1 * static_cast<double>(i);
      const double reach = std::max(std::abs(t * std::cos(angle)), std::abs(t * std::sin(angle)));
      if (std::abs(reach - 10) < 1e-6) continue;  // on the rim
      if (reach < 10) EXPECT_NEAR(z[i], 5, 1e-9) << angle << ' ' << t;
      else EXPECT_TRUE(std::isnan(z[i])) << angle << ' ' << t;
    }
  }
}

TEST(HeightProfile, FollowsACone) {
  const std::vector<double> z =
      height_profile(make_cone({0, 0, 0}, 10, 0, 20, 4096), {0, -10}, {0, 10}, 21);
  for (int i = 1; i < 20; ++i)
    EXPECT_NEAR(z[static_cast<std::size_t>(i)], 20 - 2 * std::abs(i - 10), 1e-4) << i;
}

TEST(HeightProfile, NeedsALine) {
  const TriangleMesh box = make_box({-10, -10, 0}, {10, 10, 5}, 1);
  EXPECT_THROW(height_profile(box, {1, 1}, {1, 1}, 5), UsageError);
  EXPECT_THROW(height_profile(box, {0, 0}, {1, 1}, 1), UsageError);
}

}  // namespace
}  // namespace surf
