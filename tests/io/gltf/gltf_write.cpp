// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "gltf_writer.h"
#include "io_test.h"
#include "mesh/some_surfaces.h"
#include "mesh/through_format.h"
#include "surf/io/mesh_file.h"

namespace surf::io {
namespace {

using nlohmann::json;
using test::scene_of;
using test::TemporaryFolder;

/// Coordinates about the centre have 24 bits.
constexpr double float_step = 1.0 / (1 << 23);

std::filesystem::path write_gltf(const std::filesystem::path& path, const SurfaceScene& scene,
                                 const Magnification& magnification = {}) {
  validate(scene);
  for (const OutputFile& file : test::formatted(io::gltf_format, path, scene, magnification))
    test::write(file.path, file.content);
  return path;
}

SurfaceScene read_back(const std::filesystem::path& path, std::optional<double> unit_nm = {}) {
  SurfaceScene scene = test::parsed(io::gltf_format, path, test::content_of(path), {unit_nm, true});
  validate(scene);
  return scene;
}

SurfaceScene round_trip(const SurfaceScene& scene, const Magnification& magnification = {},
                        const char* name = "f.glb") {
  const TemporaryFolder folder;
  return read_back(write_gltf(folder.path() / name, scene, magnification));
}

json json_of(const SurfaceScene& scene, const Magnification& magnification = {}) {
  return json::parse(
      test::formatted(io::gltf_format, "f.gltf", scene, magnification).back().content);
}

void expect_same(const SurfaceScene& before, const SurfaceScene& after) {
  ASSERT_EQ(after.surfaces.size(), before.surfaces.size());
  for (std::size_t i = 0; i < before.surfaces.size(); ++i) {
    const Surface &a = before.surfaces[i], &b = after.surfaces[i];
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.mesh.triangles, a.mesh.triangles);
    ASSERT_EQ(b.mesh.vertices_nm.size(), a.mesh.vertices_nm.size());
    EXPECT_LE(test::relative_shift(a, b), float_step);
    ASSERT_EQ(b.scalars.size(), a.scalars.size());
    for (std::size_t s = 0; s < a.scalars.size(); ++s) {
      EXPECT_EQ(b.scalars[s].name, a.scalars[s].name);
      EXPECT_EQ(b.scalars[s].unit, a.scalars[s].unit);
      EXPECT_EQ(b.scalars[s].values, a.scalars[s].values);
    }
    ASSERT_EQ(b.drape.has_value(), a.drape.has_value());
    if (!a.drape) continue;
    EXPECT_EQ(b.drape->grey, a.drape->grey);
    EXPECT_EQ(b.drape->name, a.drape->name);
    EXPECT_EQ(b.drape->pitch_x_nm, a.drape->pitch_x_nm);
    EXPECT_EQ(b.drape->pitch_y_nm, a.drape->pitch_y_nm);
    EXPECT_EQ(b.drape->origin_x_nm, a.drape->origin_x_nm);
    EXPECT_EQ(b.drape->origin_y_nm, a.drape->origin_y_nm);
  }
  EXPECT_EQ(after.metadata, before.metadata);
}

void expect_same_tracks(const std::vector<Track>& before, const std::vector<Track>& after) {
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Track &a = before[i], &b = after[i];
    EXPECT_EQ(b.kind, a.kind);
    EXPECT_EQ(b.electron, a.electron);
    EXPECT_EQ(b.number, a.number);
    EXPECT_EQ(b.parent, a.parent);
    EXPECT_EQ(b.generation, a.generation);
    EXPECT_EQ(b.secondary, a.secondary);
    EXPECT_EQ(b.material, a.material);
    ASSERT_EQ(b.points_nm.size(), a.points_nm.size());
    for (std::size_t p = 0; p < a.points_nm.size(); ++p) {
      EXPECT_LT(length(b.points_nm[p] - a.points_nm[p]), 1e-5);
      EXPECT_EQ(b.energy_ev[p], double{static_cast<float>(a.energy_ev[p])});
    }
  }
}

TEST(GltfWrite, AllComesBack) {
  const SurfaceScene scene = test::full_scene();
  for (const char* name : {"a b.glb", "a b.gltf"}) {
    for (const Magnification& m : {Magnification{}, Magnification{1, 1}, Magnification{3e4, 5}}) {
      SCOPED_TRACE(testing::Message() << name << " at " << m.factor);
      const SurfaceScene back = round_trip(scene, m, name);
      expect_same(scene, back);
      expect_same_tracks(scene.tracks, back.tracks);
    }
  }
}

TEST(GltfWrite, MeshReaderSeesTheSameNanometres) {
  const TemporaryFolder folder;
  const SurfaceScene scene = scene_of({"F", test::letter_f_triangles(), {}, {}});
  const auto path = write_gltf(folder.path() / "f.glb", scene, {123.0, 4});
  const std::vector<NamedMesh> meshes = read_meshes(path);
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "F");
  EXPECT_EQ(meshes[0].material, "");
  EXPECT_LE(test::relative_shift(scene.surfaces[0], {"", meshes[0].mesh, {}, {}}), float_step);
}

TEST(GltfWrite, AGivenUnitReplacesTheMagnification) {
  const TemporaryFolder folder;
  Surface f{"F", test::letter_f_triangles(), {}, {}};
  const auto path = write_gltf(folder.path() / "f.glb", scene_of(f), {1e6, 1});
  const Surface back =
      read_back(path, 7.0).surfaces.at(0);  // a metre is 7 nm, 1 nm was written as 1 mm
  for (Vec3& v : f.mesh.vertices_nm) v *= 7e-3;
  EXPECT_LE(test::relative_shift(f, back), 2 * float_step);
}

TEST(GltfWrite, TheSceneIsInMetresWithYUp) {
  const Magnification magnification{1e6, 2};
  const SurfaceScene scene = scene_of({"F", test::letter_f_triangles(), {}, {}});
  json file = json_of(scene, magnification);
  file["asset"].erase("extras");  // as a file of somebody else: in metres, nothing undone
  const TemporaryFolder folder;
  for (const OutputFile& part :
       test::formatted(io::gltf_format, folder.path() / "f.gltf", scene, magnification)) {
    test::write(part.path, part.path.extension() == ".bin" ? part.content : file.dump());
  }
  const Box box = bounds(read_mesh(folder.path() / "f.gltf", {1e3, true}));  // in mm
  const Vec3 size = bounds(scene.surfaces[0].mesh).size_nm();
  EXPECT_NEAR(box.size_nm().x, size.x, 1e-6);
  EXPECT_NEAR(box.size_nm().y, size.y, 1e-6);
  EXPECT_NEAR(box.size_nm().z, 2 * size.z, 1e-6);
  EXPECT_EQ(file["nodes"][0]["scale"][0].get<double>(), 1e-3);
}

TEST(GltfWrite, SaysWhatItHolds) {
  const json file = json_of(test::full_scene(), {1e6, 3});
  const json& own = file["asset"]["extras"]["semsurf"];
  EXPECT_EQ(file["asset"]["generator"], "semsurf 1.2");
  EXPECT_EQ(own["unit"], "nm");
  EXPECT_EQ(own["magnification"], 1e6);
  EXPECT_EQ(own["z_exaggeration"], 3);
  EXPECT_EQ(own["metadata"]["beam.energy_ev"], "1000");
  const json& attributes = file["meshes"][1]["primitives"][0]["attributes"];
  for (const char* name : {"POSITION", "NORMAL", "_HEIGHT_NM", "_CURVATURE", "_CERTAINTY"}) {
    EXPECT_TRUE(attributes.contains(name)) << name;
  }
  EXPECT_FALSE(attributes.contains("TEXCOORD_0"));
  EXPECT_TRUE(file["meshes"][0]["primitives"][0]["attributes"].contains("TEXCOORD_0"));
  EXPECT_EQ(file["images"][0]["uri"], "f_drape1.png");
  EXPECT_EQ(file["buffers"][0]["uri"], "f.bin");
  for (const json& material : file["materials"]) EXPECT_TRUE(material["doubleSided"]);
}

TEST(GltfWrite, ScalarsOfNearlyTheSameNameStayApart) {
  Surface f{"F", test::letter_f_triangles(), {}, {}};
  const std::size_t n = f.mesh.vertices_nm.size();
  f.scalars = {{"height", "nm", std::vector<float>(n, 1)},
               {"height_nm", "1", std::vector<float>(n, 2)},
               {"energy", "1e3 eV", std::vector<float>(n, -3)}};
  expect_same(scene_of(f), round_trip(scene_of(f)));
}

TEST(GltfWrite, SixteenBitsNumberWhatTheyCan) {
  const auto index_type = [](int n) {
    const json file = json_of(scene_of(test::wavy_sheet("w", n, {})));
    return file["accessors"][file["meshes"][0]["primitives"][0]["indices"].get<std::size_t>()]
               ["componentType"];
  };
  EXPECT_EQ(index_type(254), 5123);  // 65,025 vertices
  EXPECT_EQ(index_type(264), 5125);  // 70,225
  const SurfaceScene large = scene_of(test::wavy_sheet("w", 264, {}));
  expect_same(large, round_trip(large));
}

TEST(GltfWrite, AnyExtentAndAnyPlace) {
  for (const double extent : {1e-3, 1.0, 1e9}) {
    for (const double offset : {0.0, 1e7}) {
      SCOPED_TRACE(testing::Message() << extent << " nm at " << offset);
      Surface f{"F", test::letter_f_triangles(), {}, {}};
      for (Vec3& v : f.mesh.vertices_nm) v = v * extent + Vec3{offset, -offset, offset};
      const Surface back = round_trip(scene_of(f)).surfaces.at(0);
      // Where the place is far, a double itself has steps of 2e-9 nm.
      EXPECT_LE(test::relative_shift(f, back), float_step + 1e-15 * offset / extent * 8);
    }
  }
}

TEST(GltfWrite, TrianglesWithoutAreaHaveNormals) {
  Surface thin{
      "thin", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 1, 1}}}, {}, {}};
  SurfaceScene back = round_trip(scene_of(thin));
  EXPECT_EQ(back.surfaces.at(0).mesh.triangles, thin.mesh.triangles);
  Surface point{"point", {{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}, {{0, 1, 2}}}, {}, {}};
  back = round_trip(scene_of(point));
  for (const Vec3& v : back.surfaces.at(0).mesh.vertices_nm) {
    EXPECT_LT(length(v - Vec3{5, 5, 5}), 1e-14);
  }
}

TEST(GltfWrite, SameBytes) {
  const auto content = [] {
    return test::formatted(io::gltf_format, "f.glb", test::full_scene(), {}).back().content;
  };
  EXPECT_EQ(content(), content());
}

TEST(GltfWrite, NamesOfFilesNeedNotBeUtf8) {
  SurfaceScene scene = scene_of({"caf\xE9", test::letter_f_triangles(), {}, {}});
  scene.metadata = {{"a", "\xED\xA0\x80 b"}};  // half a surrogate pair
  const SurfaceScene back = round_trip(scene);
  EXPECT_EQ(back.surfaces.at(0).name, "caf\uFFFD");
  EXPECT_EQ(back.metadata.at("a"), "\uFFFD\uFFFD\uFFFD b");
}

TEST(GltfWrite, RefusesWhatItCannotHold) {
  const auto refuse = [](const SurfaceScene& scene) {
    return test::complaint<InvalidInput>(
        [&] { test::formatted(io::gltf_format, "f.glb", scene, {}); });
  };
  SurfaceScene scene = scene_of({"F", test::letter_f_triangles(), {}, {}});
  scene.metadata = {{"\xFF", "a"}};
  EXPECT_THAT(refuse(scene), testing::HasSubstr("UTF-8"));
  scene.metadata.clear();
  scene.surfaces[0].mesh.vertices_nm[3].x = 1e300;
  EXPECT_THAT(refuse(scene), testing::HasSubstr("too large"));
}

TEST(GltfWrite, DamagedExtrasAreNamed) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f.gltf";
  write_gltf(path, test::full_scene());
  const json good = json::parse(test::content_of(path));
  const auto complaint = [&](const json& file) {
    test::write(path, file.dump());
    return test::complaint<FileError>(
        [&] { test::parsed(io::gltf_format, path, test::content_of(path), {}); });
  };
  json bad = good;
  bad["asset"]["extras"]["semsurf"]["magnification"] = 0;
  EXPECT_THAT(complaint(bad), testing::HasSubstr("above 0"));
  bad = good;
  bad["meshes"][1]["extras"]["scalars"][0]["name"] = "No";
  EXPECT_THAT(complaint(bad), testing::HasSubstr("name"));
  bad = good;
  bad["meshes"].back()["extras"]["tracks"]["points"][0] = 1e9;
  EXPECT_THAT(complaint(bad), testing::HasSubstr("points"));
  bad = good;
  bad["meshes"].back()["extras"]["tracks"]["kind"] = "x";
  EXPECT_THAT(complaint(bad), testing::HasSubstr("kind"));
  std::filesystem::remove(folder.path() / "f_drape1.png");
  EXPECT_THAT(complaint(good), testing::HasSubstr("f_drape1.png"));
}

TEST(GltfWrite, AttributesOfOthersBecomeScalars) {
  json file = json_of(scene_of(test::wavy_sheet("w", 3, {})));
  file["asset"].erase("extras");
  file["meshes"][0].erase("extras");
  const TemporaryFolder folder;
  const auto parts = test::formatted(io::gltf_format, folder.path() / "f.gltf",
                                     scene_of(test::wavy_sheet("w", 3, {})), {});
  test::write(parts.front().path, parts.front().content);
  test::write(parts.back().path, file.dump());
  const Surface back = read_back(parts.back().path).surfaces.at(0);
  ASSERT_EQ(back.scalars.size(), 3u);
  EXPECT_EQ(back.scalars[2].name, "height_nm");
  EXPECT_EQ(back.scalars[2].unit, "1");
  EXPECT_EQ(back.scalars[2].values, test::wavy_sheet("w", 3, {}).scalars[0].values);
}

}  // namespace
}  // namespace surf::io
