// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/remesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/measure_mesh.h"
#include "surf/mesh/self_intersections.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

TEST(Remesh, ABoxKeepsItsFacesAndEdges) {
  const TriangleMesh box = make_box({-50, -30, 0}, {50, 30, 40});
  const TriangleMesh out = remesh(box, {.edge_nm = 6, .region_nm = bounds(box)});
  EXPECT_GT(out.triangles.size(), 700u);
  EXPECT_TRUE(check_mesh(out).closed_and_oriented);
  EXPECT_TRUE(find_self_intersections(out).pairs.empty());
  EXPECT_NEAR(measure_mesh(out).volume_nm3, 100 * 60 * 40, 1e-6);
  double longest = 0;
  for (const Triangle& t : out.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, length(out.vertices_nm[t[k]] - out.vertices_nm[t[(k + 1) % 3]]));
  EXPECT_LT(longest, 9);
}

TEST(Remesh, LeavesAloneWhatIsOutsideItsRegion) {
  const TriangleMesh box = make_box({-50, -30, 0}, {50, 30, 40});
  Box elsewhere;
  elsewhere.extend(Vec3{500, 0, 0});
  const TriangleMesh out = remesh(box, {.edge_nm = 6, .region_nm = elsewhere});
  EXPECT_EQ(out.triangles, box.triangles);
}

TEST(Remesh, RefusesBadOptionsAndMeshes) {
  const TriangleMesh box = make_box({-50, -30, 0}, {50, 30, 40});
  EXPECT_THROW(remesh(box, {.edge_nm = 0, .region_nm = bounds(box)}), UsageError);
  EXPECT_THROW(remesh(box, {.edge_nm = NAN, .region_nm = bounds(box)}), UsageError);
  EXPECT_THROW(remesh(box, {.edge_nm = 5, .region_nm = bounds(box), .rounds = 0}), UsageError);
  TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                   {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  EXPECT_THROW(remesh(fan, {.edge_nm = 1, .region_nm = bounds(fan)}), InvalidInput);
}

}  // namespace
}  // namespace surf
