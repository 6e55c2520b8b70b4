// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/reachability.h"

#include <gtest/gtest.h>

#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

struct Bodies {
  TriangleMesh mesh;
  std::vector<std::uint32_t> shell_of;
  std::vector<Shell> shells;

  void add(TriangleMesh body, int solid, int sense = 1) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices_nm.size());
    mesh.vertices_nm.insert(mesh.vertices_nm.end(), body.vertices_nm.begin(),
                            body.vertices_nm.end());
    for (const Triangle& t : body.triangles) {
      const auto a = base + t[0], b = base + t[1], c = base + t[2];
      mesh.triangles.push_back(sense > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
      shell_of.push_back(static_cast<std::uint32_t>(shells.size()));
    }
    shells.push_back({solid, sense});
  }

  // How many triangles of each shell are reachable.
  std::vector<int> reachable(double reach, std::optional<double> plane = {}) const {
    const auto answer = reachable_triangles(mesh, shell_of, shells, plane, bounds(mesh), reach);
    std::vector<int> count(shells.size(), 0);
    for (std::size_t i = 0; i < answer.size(); ++i) count[shell_of[i]] += answer[i];
    return count;
  }
};

const TriangleMesh big = make_box({-100, -100, -100}, {100, 100, 0}, 20);
const TriangleMesh small = make_box({-10, -10, -60}, {10, 10, -40}, 2);

}  // namespace

TEST(Felt, LeavesOutWhatIsDeepInsideABody) {
  Bodies b;
  b.add(big, 0);
  b.add(small, 1);
  const int all_big = static_cast<int>(big.triangles.size());
  const int all_small = static_cast<int>(small.triangles.size());
  EXPECT_EQ(b.reachable(10), (std::vector<int>{all_big, 0}));
  EXPECT_EQ(b.reachable(60), (std::vector<int>{all_big, all_small}));
  // Its top is 40 deep, its bottom 60.
  EXPECT_GT(b.reachable(42)[1], 0);
}

TEST(Felt, LeavesOutBuriedCavitiesButNotThoseWithAWayOut) {
  Bodies buried;
  buried.add(big, 0);
  buried.add(small, 0, -1);
  EXPECT_EQ(buried.reachable(10)[1], 0);
  Bodies open;
  open.add(make_box({-100, -100, -100}, {-10, 100, 0}, 4), 0);  // a slit between two bodies,
  open.add(make_box({-9.9, -100, -100}, {100, 100, 0}, 4), 0);  // narrower than any box
  open.add(make_box({-12, -10, -60}, {-11, 10, -40}), 1);
  EXPECT_EQ(open.reachable(2)[2], 12);
}

TEST(Felt, LeavesOutWhatIsBelowTheSubstrate) {
  Bodies b;
  b.add(make_box({-20, -20, 0}, {20, 20, 30}, 4), 1);
  b.add(make_box({-20, -20, -80}, {20, 20, -50}, 4), 2);
  EXPECT_GT(b.reachable(10)[1], 0);
  EXPECT_EQ(b.reachable(10, 0.0)[1], 0);
  EXPECT_EQ(b.reachable(10, 0.0)[0], static_cast<int>(b.mesh.triangles.size() / 2));
}

TEST(Felt, KeepsBodiesInTheOpen) {
  Bodies b;
  b.add(make_sphere({0, 0, 0}, 20, 3), 0);
  b.add(make_sphere({60, 0, 0}, 20, 3), 1);
  const std::vector<int> reachable = b.reachable(1);
  EXPECT_EQ(reachable[0] + reachable[1], static_cast<int>(b.mesh.triangles.size()));
}

}  // namespace surf::mc
