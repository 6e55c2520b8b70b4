// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include <cstdlib>

#include "io_test.h"
#include "surf/io/files.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/check_mesh.h"

namespace surf::io {
namespace {

namespace fs = std::filesystem;

class RealMeshes : public test::RealFiles {
 protected:
  void SetUp() override {
    RealFiles::SetUp();
    if (IsSkipped()) return;
    truth_ = nlohmann::json::parse(read_file(root_ / "truth" / "meshes.json"));
  }

  /// The measured facts of a file, or null.
  nlohmann::json truth(const std::string& file) const {
    for (const auto& entry : truth_) {
      if (entry["file"] == file) return entry;
    }
    return nullptr;
  }

  nlohmann::json truth_;
};

/// `facts` come from another reader. They count vertices as stored, with `dupV` of them duplicates
/// and `unused` of them of no triangle. Meshes with non-manifold edges are never closed to it; here
/// they are if triangles run through every edge equally often both ways (`balanced`).
void expect_facts(const TriangleMesh& mesh, const nlohmann::json& facts, std::size_t unused = 0,
                  bool balanced = false) {
  const MeshReport report = check_mesh(mesh);
  const auto count = [&](const char* key) { return facts[key].get<std::size_t>(); };
  EXPECT_EQ(mesh.triangles.size(), count("T"));
  if (facts["fmt"] == "glb") return;  // nothing else is known
  EXPECT_EQ(mesh.vertices_nm.size(), count("V") - count("dupV") - unused);
  EXPECT_EQ(report.boundary_edges, count("boundary_edges"));
  EXPECT_EQ(report.nonmanifold_edges, count("nonmanifold_edges"));
  EXPECT_EQ(report.doubled_directed_edges, count("inconsistent_oriented_edges"));
  EXPECT_EQ(report.degenerate_triangles, count("degenerate"));
  EXPECT_EQ(report.duplicate_triangles, count("dup_faces"));
  const double area = facts["area"];
  EXPECT_NEAR(report.area_nm2, area, 1e-6 * area);
  EXPECT_EQ(report.closed_and_oriented, facts["closed"].get<bool>() || balanced);
  if (!facts["closed"].get<bool>()) return;
  const double volume = facts["signed_volume"];
  EXPECT_NEAR(report.signed_volume_nm3, volume, 1e-6 * std::abs(volume));
}

TEST_F(RealMeshes, GoodFilesAgreeWithAnotherReader) {
  int read = 0;
  for (const auto& entry : fs::directory_iterator(root_ / "mesh")) {
    if (!is_mesh_file(entry.path())) continue;
    SCOPED_TRACE(entry.path());
    const auto facts = truth("mesh/" + entry.path().filename().string());
    ASSERT_FALSE(facts.is_null());
    // The facts are in the files' own units; areas and volumes do not depend on the axes.
    expect_facts(read_mesh(entry.path(), {1.0, true}), facts);
    ++read;
  }
  EXPECT_GE(read, 16);
}

TEST_F(RealMeshes, NestedGltfKeepsItsNodes) {
  const auto meshes = read_meshes(root_ / "mesh" / "nested.glb", {1.0, true});
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_EQ(meshes[0].name, "block01");
  EXPECT_EQ(meshes[1].name, "block02");
  EXPECT_EQ(meshes[2].name, "block03");
  for (const NamedMesh& part : meshes) {
    EXPECT_EQ(part.material, "Material");
    EXPECT_TRUE(check_mesh(part.mesh).closed_and_oriented);
  }
  // The middle of the deepest block, by hand from the three nodes: cubes about their origins.
  const Vec3 one{-0.897631824016571, 0.6829495429992676, 0};
  const double s1[3] = {0.26938149333000183, 0.28434106707572937, 0.26938149333000183};
  const Vec3 two = one + Vec3{s1[0] * 3.332195520401001, s1[1] * -2.401867389678955, 0};
  const Vec3 three = two + Vec3{0, s1[1] * 3.5169029235839844 * -1.7263891696929932, 0};
  const Vec3 middle = bounds(meshes[2].mesh).center_nm();
  EXPECT_NEAR(middle.x, three.x, 1e-9);
  EXPECT_NEAR(middle.y, 0, 1e-9);
  EXPECT_NEAR(middle.z, three.y, 1e-9);
}

TEST_F(RealMeshes, BrokenFilesAreReadOrRefused) {
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(root_ / "mesh" / "broken")) {
    SCOPED_TRACE(entry.path());
    try {
      const TriangleMesh mesh = read_mesh(entry.path());
      validate(mesh);
      const auto facts = truth("mesh/broken/" + entry.path().filename().string());
      const auto name = entry.path().filename();
      // degenerated.obj holds every face twice, the second time turned over.
      expect_facts(mesh, facts, name == "cube-ouvert.off" ? 1 : 0, name == "degenerated.obj");
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(entry.path().filename().string()));
      RecordProperty(entry.path().filename().string(), error.what());
    }
    ++seen;
  }
  EXPECT_GE(seen, 20);
}

TEST_F(RealMeshes, FilesWithoutASurfaceAreRefused) {
  for (const char* name : {"cow_binary_truncated.ply", "empty.stl", "notenoughindices.obj",
                           "points_only_bin.ply", "stl_empty_bin.stl"}) {
    SCOPED_TRACE(name);
    test::complaint<FileError>([&] { read_mesh(root_ / "mesh" / "broken" / name); });
  }
}

}  // namespace
}  // namespace surf::io
