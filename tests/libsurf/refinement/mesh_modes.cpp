// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/refinement/mesh_modes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "surf/mesh/remesh.h"
#include "surf/mesh/shapes.h"
#include "surf/mesh/vertex_normals.h"

namespace surf {
namespace {

TriangleMesh plate(double thickness_nm) {
  const Box box{{-40, -40, 0}, {40, 40, thickness_nm}};
  return remesh(make_box(box.lower_nm, box.upper_nm), {.edge_nm = 5, .region_nm = box});
}

TEST(SmoothModes, MoveNothingByMoreThanTheirAmplitude) {
  const TriangleMesh mesh = plate(60);
  const std::vector<MeshMode> modes = smooth_modes(mesh, bounds(mesh));
  EXPECT_EQ(modes.size(), 27u);
  for (const MeshMode& mode : modes) {
    EXPECT_FALSE(mode.is_bump());
    for (const MeshMode::Move& move : mode.moves) EXPECT_LE(length(move.by), 1 + 1e-12);
  }
}

TEST(SmoothModes, MakeATaperAndNoShift) {
  const TriangleMesh mesh = plate(60);
  const std::vector<MeshMode> modes = smooth_modes(mesh, bounds(mesh));
  bool taper = false;
  for (const MeshMode& mode : modes) {
    // Walls at x = 40 lean outwards, those at x = -40 the other way.
    taper = taper || std::ranges::all_of(mode.moves, [&](const MeshMode::Move& m) {
              const Vec3& p = mesh.vertices_nm[m.vertex];
              return std::abs(m.by.x - p.x / 40 * (p.z - 30) / 30) < 1e-9 && m.by.y == 0;
            });
    Vec3 first = mode.moves.front().by;
    EXPECT_FALSE(
        mode.moves.size() == mesh.vertices_nm.size() &&
        std::ranges::all_of(mode.moves, [&](const MeshMode::Move& m) { return m.by == first; }));
  }
  EXPECT_TRUE(taper);
}

TEST(SmoothModes, MoveAlikeWhatIsBesideTheirBox) {
  const TriangleMesh mesh = plate(60);
  Box box = bounds(mesh);
  box.lower_nm.x = -20, box.upper_nm.x = 15;
  for (const MeshMode& mode : smooth_modes(mesh, box)) {
    std::map<std::array<double, 2>, Vec3> beyond;
    for (const MeshMode::Move& move : mode.moves) {
      const Vec3& p = mesh.vertices_nm[move.vertex];
      if (p.x < 15) continue;
      const auto [at, is_new] = beyond.try_emplace({p.y, p.z}, move.by);
      if (!is_new) {
        EXPECT_LT(length(at->second - move.by), 1e-12);
      }
    }
  }
}

TEST(SmoothModes, LeaveTheRimOfASheetWhereItIs) {
  const TriangleMesh sheet{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 1}},
                           {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  for (const MeshMode& mode : smooth_modes(sheet, bounds(sheet)))
    for (const MeshMode::Move& move : mode.moves) EXPECT_EQ(move.vertex, 4u);
}

TEST(SmoothModes, OfWallsAreSizesLeansAndTapers) {
  const TriangleMesh mesh = plate(60);
  const std::vector<MeshMode> modes = smooth_modes(mesh, bounds(mesh), SmoothKind::walls);
  ASSERT_EQ(modes.size(), 7u);
  EXPECT_EQ(std::ranges::count_if(modes, &MeshMode::vertical), 1);
}

TEST(SmoothModes, TheHeightIsThatOverTheGround) {
  const TriangleMesh mesh = plate(60);
  const std::vector<MeshMode> modes = smooth_modes(mesh, bounds(mesh), SmoothKind::walls);
  const auto height = std::ranges::find_if(modes, &MeshMode::vertical);
  ASSERT_NE(height, modes.end());
  EXPECT_FALSE(height->moves.empty());
  for (const MeshMode::Move& move : height->moves)
    EXPECT_NEAR(move.by.z, mesh.vertices_nm[move.vertex].z / 60, 1e-12);
}

TEST(BumpModes, AddUpToTheSurfaceMovingAlongItsNormals) {
  const TriangleMesh mesh = plate(60);
  std::vector<bool> may_move;
  for (const Vec3& p : mesh.vertices_nm) may_move.push_back(p.z > 1);
  const std::vector<MeshMode> modes = bump_modes(mesh, may_move, 12);
  EXPECT_GT(modes.size(), 50u);
  const TriangleMesh out = moved(mesh, modes, std::vector<double>(modes.size(), 2.0));
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < may_move.size(); ++v)
    EXPECT_NEAR(
        length(out.vertices_nm[v] - mesh.vertices_nm[v] - normals[v] * (may_move[v] ? 2.0 : 0.0)),
        0, 1e-9);
}

TEST(BumpModes, DoNotReachThroughAThinWall) {
  const TriangleMesh mesh = plate(4);
  const std::vector<MeshMode> modes =
      bump_modes(mesh, std::vector<bool>(mesh.vertices_nm.size(), true), 10);
  bool tested = false;
  for (const MeshMode& mode : modes) {
    if (std::abs(mode.middle_nm.x) > 15 || std::abs(mode.middle_nm.y) > 15) continue;
    tested = true;
    for (const MeshMode::Move& move : mode.moves)
      EXPECT_NEAR(mesh.vertices_nm[move.vertex].z, mode.middle_nm.z, 1);
  }
  EXPECT_TRUE(tested);
}

TEST(GroupsApart, HoldEachModeOnceAndBumpsThatDoNotTouch) {
  const TriangleMesh mesh = plate(60);
  std::vector<MeshMode> modes = smooth_modes(mesh, bounds(mesh));
  const std::size_t smooth = modes.size();
  for (MeshMode& m : bump_modes(mesh, std::vector<bool>(mesh.vertices_nm.size(), true), 12))
    modes.push_back(std::move(m));
  const auto groups = groups_apart(modes, 10);
  EXPECT_LT(groups.size(), smooth + (modes.size() - smooth) / 2);
  std::vector<int> times(modes.size(), 0);
  for (const auto& group : groups)
    for (const std::size_t a : group) {
      ++times[a];
      if (!modes[a].is_bump()) {
        EXPECT_EQ(group.size(), 1u);
      }
      for (const std::size_t b : group)
        if (a != b) {
          EXPECT_GE(length(modes[a].middle_nm - modes[b].middle_nm),
                    modes[a].reach_nm + modes[b].reach_nm + 10);
        }
    }
  for (const int t : times) EXPECT_EQ(t, 1);
}

TEST(PriorCovariance, PartsFarPlacesAndOppositeFaces) {
  const auto bump = [](Vec3 middle, Vec3 normal) { return MeshMode{{}, middle, normal, 5}; };
  const std::vector<MeshMode> modes{{{}, {}, {}, 0},
                                    bump({0, 0, 0}, {0, 0, 1}),
                                    bump({10, 0, 0}, {0, 0, 1}),
                                    bump({0, 0, -2}, {0, 0, -1}),
                                    bump({200, 0, 0}, {0, 0, 1})};
  const std::vector<double> c =
      prior_covariance(modes, {.smooth_nm = 7, .bump_nm = 2, .length_nm = 10});
  const auto at = [&](std::size_t k, std::size_t l) { return c[k * modes.size() + l]; };
  EXPECT_DOUBLE_EQ(at(0, 0), 49);
  EXPECT_EQ(at(0, 1), 0);
  EXPECT_NEAR(at(1, 1), 4, 1e-3);
  EXPECT_NEAR(at(1, 2), 4 * std::exp(-0.5), 1e-3);
  EXPECT_LT(at(1, 3), 0.1);
  EXPECT_LT(at(1, 4), 1e-6);
}

}  // namespace
}  // namespace surf
