// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/touching_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {

TEST(TouchingVertices, AreThoseNearTheOthersSurface) {
  const TriangleMesh box = make_box({0, 0, 0}, {4, 4, 4}, 4);
  const auto touching = touching_vertices(box, make_box({1, 1, 4.001}, {9, 9, 9}), 0.01);
  for (std::size_t i = 0; i < box.vertices_nm.size(); ++i) {
    const Vec3& p = box.vertices_nm[i];
    EXPECT_EQ(touching[i], p.z == 4 && p.x >= 1 && p.y >= 1) << p.x << " " << p.y << " " << p.z;
  }
  const auto none = touching_vertices(box, make_box({1, 1, 4.001}, {9, 9, 9}), 0);
  EXPECT_EQ(std::ranges::count(none, 1), 0);
  const TriangleMesh roof{{{0, 0, 4.5}, {4, 0, 3.5}, {0, 4, 3.5}}, {{0, 1, 2}}};
  const auto below = touching_vertices(box, roof, 0.01);
  for (std::size_t i = 0; i < box.vertices_nm.size(); ++i) {
    const Vec3& p = box.vertices_nm[i];
    EXPECT_EQ(below[i], p.z == 4 && p.x + p.y == 2) << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_THROW(touching_vertices(box, box, -1), UsageError);
  EXPECT_THROW(touching_vertices(box, {}, 1), InvalidInput);
}

}  // namespace surf
