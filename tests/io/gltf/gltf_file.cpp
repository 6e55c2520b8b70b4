// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "gltf_writer.h"
#include "io_test.h"
#include "surf/io/mesh_file.h"
#include "surf/mesh/check_mesh.h"

namespace surf::io {
namespace {

using nlohmann::json;
using test::bytes;
using test::corners;
using test::GltfWriter;
using test::TemporaryFolder;
using test::write;

std::vector<NamedMesh> read(const std::string& name, const std::string& content,
                            double unit_nm = 1) {
  const TemporaryFolder folder;
  return read_meshes(write(folder.path() / name, content), {unit_nm, true});
}

NamedMesh read_one(const GltfWriter& gltf) {
  std::vector<NamedMesh> meshes = read("f.glb", gltf.glb());
  EXPECT_EQ(meshes.size(), 1u);
  return meshes.empty() ? NamedMesh{} : meshes.front();
}

void expect_letter_f(const TriangleMesh& mesh) {
  EXPECT_EQ(corners(mesh), corners(test::letter_f_triangles()));
  EXPECT_EQ(mesh.vertices_nm.size(), test::letter_f_triangles().vertices_nm.size());
}

/// The letter at other places, exactly: `map` is applied to each vertex.
template <class Map>
std::vector<std::array<Vec3, 3>> moved_letter(const Map& map) {
  TriangleMesh mesh = test::letter_f_triangles();
  for (Vec3& v : mesh.vertices_nm) v = map(v);
  return corners(mesh);
}

TEST(GltfFile, ReadsTheLetter) {
  const NamedMesh f = read_one(test::gltf_of_f());
  expect_letter_f(f.mesh);
  EXPECT_EQ(f.name, "F");
  EXPECT_EQ(f.material, "");
}

TEST(GltfFile, ReadsDataUrisAndFilesBesideIt) {
  const GltfWriter gltf = test::gltf_of_f();
  const std::string data =
      "data:application/octet-stream;base64," + GltfWriter::base64(gltf.binary);
  expect_letter_f(read("f.gltf", gltf.text(data)).at(0).mesh);

  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  write(folder.path() / "sub" / "a b.bin", gltf.binary);
  const auto path = write(folder.path() / "f.gltf", gltf.text("sub/a%20b.bin"));
  expect_letter_f(read_mesh(path, {1.0, true}));
  EXPECT_EQ(mesh_input_files(path), (std::vector{path, folder.path() / "sub" / "a b.bin"}));
}

TEST(GltfFile, AUnitIsOneMetreUnlessGiven) {
  const TemporaryFolder folder;
  const auto path = write(folder.path() / "f.glb", test::gltf_of_f().glb());
  EXPECT_EQ(corners(read_mesh(path)), moved_letter([](const Vec3& v) { return v * 1e9; }));
  EXPECT_EQ(corners(read_mesh(path, {2.0, true})),
            moved_letter([](const Vec3& v) { return v * 2; }));
}

TEST(GltfFile, YUpBecomesZUp) {
  GltfWriter gltf;
  const std::string content =
      bytes(1.F, false) + bytes(2.F, false) + bytes(3.F, false) + std::string(24, '\0');
  const int positions = gltf.add_accessor(gltf.add_view(content), test::gltf_float32, 3, "VEC3");
  gltf.add_node({{"mesh", gltf.add_mesh(positions, -1)}});
  EXPECT_EQ(read_one(gltf).mesh.vertices_nm.at(0), (Vec3{1, -3, 2}));
}

TEST(GltfFile, AppliesTransformsFromTheRootDown) {
  GltfWriter gltf = test::gltf_of_f();
  // Scale, then a quarter turn about the vertical (y) axis, then a shift; its parent shifts up.
  gltf.json["nodes"][0].update({{"scale", {2, 2, 2}},
                                {"rotation", {0, 3, 0, 3}},  // of any length
                                {"translation", {10, 0, 0}}});
  const int parent = gltf.add_node({{"children", {0}}, {"translation", {0, 5, 0}}});
  gltf.json["scenes"] = {{{"nodes", json::array()}}, {{"nodes", {parent}}}};
  gltf.json["scene"] = 1;
  const auto expected = moved_letter([](const Vec3& v) {
    return Vec3{10 - 2 * v.y, 2 * v.x, 2 * v.z + 5};
  });
  const auto found = corners(read_one(gltf).mesh);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t t = 0; t < found.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(length(found[t][c] - expected[t][c]), 1e-14);
  }
}

TEST(GltfFile, MatricesAreByColumns) {
  GltfWriter gltf = test::gltf_of_f();
  // x -> y, y -> z, z -> x, then (7, 8, 9): in z-up terms (x, y, z) -> (7 - y, -9 - z, 8 + x).
  gltf.json["nodes"][0]["matrix"] = {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 7, 8, 9, 1};
  EXPECT_EQ(corners(read_one(gltf).mesh), moved_letter([](const Vec3& v) {
              return Vec3{7 - v.y, -9 - v.z, 8 + v.x};
            }));
}

TEST(GltfFile, MirroringKeepsNormalsOut) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.json["nodes"][0]["scale"] = {-1, 1, 1};
  const NamedMesh f = read_one(gltf);
  EXPECT_TRUE(check_mesh(f.mesh).closed_and_oriented);
  EXPECT_GT(check_mesh(f.mesh).signed_volume_nm3, 0);
  EXPECT_EQ(bounds(f.mesh).lower_nm.x, -3);
}

TEST(GltfFile, AMeshIsRepeatedForEveryNode) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.add_node({{"mesh", 0}, {"translation", {0, 100, 0}}});
  gltf.add_node({{"name", "nothing"}});
  const auto meshes = read("part.glb", gltf.glb());
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_EQ(meshes[0].name, "F");
  EXPECT_EQ(meshes[1].name, "part") << "neither node nor mesh has a name";
  EXPECT_EQ(corners(meshes[1].mesh), moved_letter([](const Vec3& v) {
              return v + Vec3{0, 0, 100};
            }));
}

TEST(GltfFile, PrimitivesAreSortedByMaterial) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.json["materials"] = {{{"name", "Au"}}, json::object()};
  json& primitives = gltf.json["meshes"][0]["primitives"];
  const json plain = primitives[0];
  primitives = json::array();
  for (const int material : {0, 1, 0, -1}) {
    primitives.push_back(plain);
    if (material >= 0) primitives.back()["material"] = material;
  }
  const auto meshes = read("f.glb", gltf.glb());
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_EQ(meshes[0].material, "Au");
  EXPECT_EQ(meshes[0].mesh.triangles.size(), 2 * test::letter_f_triangles().triangles.size());
  EXPECT_EQ(meshes[1].material, "");
  EXPECT_EQ(meshes[2].material, "");
  for (const NamedMesh& mesh : meshes) EXPECT_EQ(mesh.name, "F");
}

TEST(GltfFile, ReadsEveryTypeOfIndex) {
  const TriangleMesh f = test::letter_f_triangles();
  std::vector<std::uint32_t> all;
  for (const Triangle& t : f.triangles) all.insert(all.end(), t.begin(), t.end());
  for (const auto type : {test::gltf_uint8, test::gltf_uint16, test::gltf_uint32}) {
    GltfWriter gltf;
    gltf.add_node(
        {{"mesh", gltf.add_mesh(gltf.add_positions(f.vertices_nm), gltf.add_indices(all, type))}});
    expect_letter_f(read_one(gltf).mesh);
  }
}

TEST(GltfFile, ReadsTrianglesWithoutIndices) {
  std::vector<Vec3> points;
  for (const auto& t : corners(test::letter_f_triangles())) {
    points.insert(points.end(), t.begin(), t.end());
  }
  GltfWriter gltf;
  gltf.add_node({{"mesh", gltf.add_mesh(gltf.add_positions(points), -1)}});
  expect_letter_f(read_one(gltf).mesh);
}

TEST(GltfFile, ReadsStripsAndFans) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  GltfWriter gltf;
  // The repeated corner joins two strips and is no triangle.
  gltf.add_node(
      {{"mesh", gltf.add_mesh(gltf.add_positions(square), gltf.add_indices({0, 1, 2, 3, 4, 4}))}});
  json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["mode"] = 5;
  EXPECT_EQ(read_one(gltf).mesh.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  primitive["mode"] = 6;
  gltf.json["accessors"][primitive["indices"].get<int>()]["count"] = 5;
  EXPECT_EQ(read_one(gltf).mesh.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(GltfFile, SkipsPointsAndLines) {
  GltfWriter gltf = test::gltf_of_f();
  json& primitives = gltf.json["meshes"][0]["primitives"];
  for (const int mode : {0, 1, 2, 3}) {
    primitives.push_back(primitives[0]);
    primitives.back()["mode"] = mode;
  }
  primitives.push_back({{"attributes", json::object()}});  // without positions
  expect_letter_f(read_one(gltf).mesh);
}

TEST(GltfFile, ReadsStridedViewsAndOffsets) {
  const TriangleMesh f = test::letter_f_triangles();
  std::string content = "junk";
  for (const Vec3& p : f.vertices_nm) {
    for (const double c : {p.x, p.z, -p.y}) content += bytes(static_cast<float>(c), false);
    content += "normal..";
  }
  content.resize(content.size() - 8);  // the last element need not be padded
  GltfWriter gltf = test::gltf_of_f();
  json& accessor = gltf.json["accessors"][0];
  accessor["bufferView"] = gltf.add_view(content, 20);
  accessor["byteOffset"] = 4;
  expect_letter_f(read_one(gltf).mesh);
}

/// The letter as whole numbers 4 times its size (its steps are 1, 0.5 and 0.25).
template <class Integer>
GltfWriter quantized_letter(test::GltfType type, bool normalized, double largest) {
  const TriangleMesh f = test::letter_f_triangles();
  std::string content;
  for (const Vec3& p : f.vertices_nm) {
    const double step = normalized ? std::floor(largest / 16) : 1;
    for (const double c : {p.x, p.z, 3 - p.y}) {  // not below 0
      content += bytes(static_cast<Integer>(std::lround(4 * c * step)), false);
    }
    content.resize((content.size() + 3) / 4 * 4);
  }
  GltfWriter gltf = test::gltf_of_f();
  json& accessor = gltf.json["accessors"][0];
  accessor["bufferView"] =
      gltf.add_view(content, static_cast<int>(content.size() / f.vertices_nm.size()));
  accessor["componentType"] = type;
  accessor["normalized"] = normalized;
  const double scale = 0.25 * (normalized ? largest / std::floor(largest / 16) : 1);
  gltf.json["nodes"][0]["scale"] = {scale, scale, scale};
  gltf.json["nodes"][0]["translation"] = {0, 0, -3};
  gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  return gltf;
}

void expect_near_letter(const GltfWriter& gltf) {
  const auto found = corners(read_one(gltf).mesh);
  const auto expected = corners(test::letter_f_triangles());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t t = 0; t < found.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(length(found[t][c] - expected[t][c]), 1e-12);
  }
}

TEST(GltfFile, ReadsQuantizedPositions) {
  for (const bool normalized : {false, true}) {
    SCOPED_TRACE(normalized);
    expect_near_letter(quantized_letter<std::int8_t>(test::gltf_int8, normalized, 127));
    expect_near_letter(quantized_letter<std::uint8_t>(test::gltf_uint8, normalized, 255));
    expect_near_letter(quantized_letter<std::int16_t>(test::gltf_int16, normalized, 32767));
    expect_near_letter(quantized_letter<std::uint16_t>(test::gltf_uint16, normalized, 65535));
  }
}

TEST(GltfFile, ReadsSparsePositions) {
  GltfWriter gltf = test::gltf_of_f();
  const std::string replaced = bytes(50.F, false) + bytes(60.F, false) + bytes(-70.F, false);
  gltf.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", gltf.add_view(bytes(std::uint16_t{5}, false))},
        {"componentType", test::gltf_uint16}}},
      {"values", {{"bufferView", gltf.add_view(replaced)}}}};
  TriangleMesh expected = test::letter_f_triangles();
  expected.vertices_nm.at(5) = {50, 70, 60};
  EXPECT_EQ(corners(read_one(gltf).mesh), corners(expected));

  // Without a view of its own the rest is zero.
  gltf.json["accessors"][0].erase("bufferView");
  for (std::size_t i = 0; i < expected.vertices_nm.size(); ++i) {
    if (i != 5) expected.vertices_nm[i] = {0, 0, 0};
  }
  EXPECT_EQ(corners(read_one(gltf).mesh), corners(expected));
}

TEST(GltfFile, ImagesAreNotLoaded) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.json["images"] = {{{"uri", "missing.png"}}, {{"bufferView", 99}, {"mimeType", "image/png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  expect_letter_f(read_one(gltf).mesh);
}

TEST(GltfFile, DeepNestingIsNoDanger) {
  GltfWriter gltf = test::gltf_of_f();
  const std::string text = gltf.json.dump();
  const std::size_t depth = 300000;
  const std::string deep = text.substr(0, text.size() - 1) +
                           ",\"extras\":" + std::string(depth, '[') + std::string(depth, ']') +
                           ",\"buffers\":[{\"byteLength\":" + std::to_string(gltf.binary.size()) +
                           "}]}";
  expect_letter_f(read("f.glb", GltfWriter::container(deep, gltf.binary)).at(0).mesh);
}

TEST(GltfFile, ALongChainOfNodesIsNoDanger) {
  GltfWriter gltf = test::gltf_of_f();
  for (int i = 0; i < 100000; ++i) {
    gltf.json["nodes"].push_back({{"children", {i}}, {"translation", {0, 1, 0}}});
  }
  EXPECT_EQ(bounds(read_one(gltf).mesh).lower_nm.z, 100000);
}

}  // namespace
}  // namespace surf::io
