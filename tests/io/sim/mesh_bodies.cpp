// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/sim/mesh_bodies.h"

#include "../io_test.h"
#include "gltf/gltf_writer.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mesh/check_mesh.h"

namespace surf::io {
namespace {

using nlohmann::json;
using test::complaint;
using test::GltfWriter;
using test::TemporaryFolder;
using test::write;
using testing::HasSubstr;

/// Three letters of the materials "Au", "paint" and none.
class MeshBodies : public testing::Test {
 protected:
  MeshBodies() {
    GltfWriter gltf = test::gltf_of_f();
    gltf.json["materials"] = {{{"name", "Au"}}, {{"name", "paint"}}};
    gltf.json["nodes"] = json::array();
    for (const int material : {0, 1, -1}) {
      json mesh = gltf.json["meshes"][0];
      if (material >= 0) mesh["primitives"][0]["material"] = material;
      gltf.json["meshes"].push_back(mesh);
      gltf.add_node({{"mesh", gltf.json["meshes"].size() - 1},
                     {"name", fmt::format("F{}", material)},
                     {"translation", {0, 10 * material, 0}}});
    }
    path_ = write(folder_.path() / "three.glb", gltf.glb());
  }

  TemporaryFolder folder_;
  std::filesystem::path path_;
};

std::vector<std::string> materials(const std::vector<MeshBody>& bodies) {
  std::vector<std::string> names;
  for (const MeshBody& body : bodies) names.push_back(body.material);
  return names;
}

TEST_F(MeshBodies, KnownNamesAreTakenOthersAreTheDefault) {
  const auto bodies = read_mesh_bodies(path_, {1.0, true}, {.fallback = "Cu"});
  EXPECT_EQ(materials(bodies), (std::vector<std::string>{"Au", "Cu", "Cu"}));
  EXPECT_FALSE(bodies[0].is_default);
  EXPECT_TRUE(bodies[1].is_default);
  EXPECT_EQ(bodies[1].file_material, "paint");
  EXPECT_EQ(bodies[2].name, "F-1");
}

TEST_F(MeshBodies, MeaningsComeFirst) {
  const auto bodies =
      read_mesh_bodies(path_, {1.0, true}, {.meaning = {{"paint", "C"}, {"Au", "Al"}}});
  EXPECT_EQ(materials(bodies), (std::vector<std::string>{"Al", "C", "Si"}));
  EXPECT_FALSE(bodies[1].is_default);
}

TEST_F(MeshBodies, RefusesNamesThatMeanNothing) {
  EXPECT_THAT(
      complaint<UsageError>([&] {
        read_mesh_bodies(path_, {1.0, true},
                         {.meaning = {{"pain", "C"}}, .subject = "--materials"});
      }),
      testing::AllOf(HasSubstr("--materials"), HasSubstr("'pain'"), HasSubstr("paint, Au")));
  EXPECT_THAT(complaint<UsageError>([&] {
                read_mesh_bodies(path_, {1.0, true}, {.meaning = {{"paint", "Xx"}}});
              }),
              HasSubstr("Xx"));
  EXPECT_THAT(complaint<UsageError>([&] {
                read_mesh_bodies(path_, {1.0, true}, {.fallback = "Xx"});
              }),
              HasSubstr("Xx"));
}

TEST(MeshBodiesOfObj, APaintedBodyIsOneAgain) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const TemporaryFolder folder;
  const auto path = write(folder.path() / "a.obj",
                          points + "usemtl red\nf 1 3 2\nf 1 2 4\nusemtl blue\nf 1 4 3\nf 2 3 4\n");
  const auto bodies = read_mesh_bodies(path, {}, {});
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_TRUE(check_mesh(bodies[0].mesh).closed_and_oriented);
  EXPECT_EQ(bodies[0].file_material, "");
  EXPECT_EQ(read_mesh_bodies(path, {}, {.meaning = {{"red", "Au"}}}).size(), 2u);
}

TEST_F(MeshBodies, SceneFilesTakeThemAll) {
  const auto scene_path = write(folder_.path() / "scene.toml", R"(
    [[body]]
    mesh = "three.glb"
    unit = "nm"
    override_unit = true
    material = "Si"
    materials = { paint = "C" }
    move = [0, 0, 1]
    [[body]]
    name = "second"
    mesh = "three.glb"
    material = "Cu"
  )");
  const mc::Specimen specimen = read_scene(scene_path).specimen;
  ASSERT_EQ(specimen.bodies.size(), 6u);
  EXPECT_EQ(specimen.materials.size(), 4u) << "each once, none unused";
  const auto expect_body = [&](std::size_t i, const char* name, const char* material) {
    EXPECT_EQ(specimen.bodies[i].name, name);
    EXPECT_EQ(specimen.materials.at(static_cast<std::size_t>(specimen.bodies[i].material)).name,
              material);
  };
  expect_body(0, "F0", "Au");
  expect_body(1, "F1", "C");
  expect_body(2, "F-1", "Si");
  expect_body(3, "second, F0", "Au");
  expect_body(5, "second, F-1", "Cu");
  EXPECT_EQ(bounds(specimen.bodies[1].mesh).lower_nm.z, 11) << "moved";
  EXPECT_EQ(bounds(specimen.bodies[4].mesh).lower_nm.z, 1e10) << "in metres";

  write(scene_path,
        "[[body]]\nmesh = \"three.glb\"\nmaterial = \"Si\"\nmaterials = { x = \"C\" }\n");
  EXPECT_THAT(complaint<UsageError>([&] { read_scene(scene_path); }),
              testing::AllOf(HasSubstr("body[1].materials"), HasSubstr("'x'")));
}

}  // namespace
}  // namespace surf::io
