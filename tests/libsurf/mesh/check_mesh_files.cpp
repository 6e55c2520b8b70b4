// SPDX-License-Identifier: GPL-3.0-or-later
// check_mesh on real meshes, sound and broken. The numbers were counted by an independent program.
#include <gtest/gtest.h>

#include <cctype>
#include <ostream>
#include <string>

#include "off.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

struct Truth {
  const char* file;
  std::size_t vertices;
  std::size_t triangles;
  std::size_t boundary_edges;
  std::size_t inconsistent_edges;
  bool closed;
  std::size_t components;
  double area;
  double volume;  ///< of closed meshes

  friend std::ostream& operator<<(std::ostream& out, const Truth& t) { return out << t.file; }
};

// cube.off is a box of side sqrt(2) turned by 45 degrees: its corners lie on the unit circle, so
// its volume is 4 and not 8. One of cube-ouvert.off's nine vertices belongs to no triangle.
constexpr Truth truths[] = {
    {"mesh/cube.off", 8, 12, 0, 0, true, 1, 15.313708498984763, 4.0},
    {"mesh/bunny_libigl.off", 3485, 6966, 0, 0, true, 1, 0.058212918687553586,
     0.000753934230107923},
    {"mesh/triceratops.off", 2832, 5660, 0, 0, true, 1, 219.91565490848382, 136.7323004476689},
    {"mesh/fandisk.off", 7229, 14454, 0, 0, true, 1, 60.64493395365887, 20.267310930533043},
    {"mesh/broken/2triangles_open.off", 4, 2, 4, 0, false, 1, 1.5731321849709863, 0},
    {"mesh/broken/cube-ouvert.off", 8, 10, 4, 0, false, 1, 20.0, 0},
    {"mesh/broken/fold.off", 12, 12, 10, 0, false, 1, 0.06598538213223706, 0},
    {"mesh/broken/blobby-shuffled.off", 2027, 4050, 0, 3069, false, 1, 0.7766036968948717, 0},
    {"mesh/broken/elephant-with-holes.off", 2733, 4463, 1353, 0, false, 1, 1.0160237015072147, 0},
    {"mesh/broken/mech-holes-shark.off", 5246, 10192, 304, 0, false, 1, 4.011929448585067, 0},
    {"mesh/broken/quads_to_stitch.off", 15, 16, 12, 0, false, 1, 2.0, 0},
};

class CheckMeshFile : public testing::TestWithParam<Truth> {};

}  // namespace

TEST_P(CheckMeshFile, AgreesWithTheTruth) {
  const Truth& truth = GetParam();
  const auto path = test::test_data(truth.file);
  if (!path) GTEST_SKIP() << "needs " << truth.file << " below SEMSURF_TEST_DATA";
  const MeshReport r = check_mesh(test::read_off(*path));
  EXPECT_EQ(r.vertices, truth.vertices);
  EXPECT_EQ(r.triangles, truth.triangles);
  EXPECT_EQ(r.degenerate_triangles, 0u);
  EXPECT_EQ(r.duplicate_triangles, 0u);
  EXPECT_EQ(r.boundary_edges, truth.boundary_edges);
  EXPECT_EQ(r.nonmanifold_edges, 0u);
  EXPECT_EQ(r.inconsistent_edges, truth.inconsistent_edges);
  EXPECT_EQ(r.closed_and_oriented, truth.closed);
  EXPECT_EQ(r.components, truth.components);
  EXPECT_NEAR(r.area_nm2, truth.area, 1e-12 * truth.area);
  if (truth.closed) {
    EXPECT_NEAR(r.signed_volume_nm3, truth.volume, 1e-10 * truth.volume);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, CheckMeshFile, testing::ValuesIn(truths), [](const auto& entry) {
  std::string name = entry.param.file;
  name = name.substr(name.rfind('/') + 1);
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
});

}  // namespace surf
