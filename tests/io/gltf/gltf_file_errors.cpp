// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "gltf_writer.h"
#include "io_test.h"
#include "surf/io/mesh_file.h"

namespace surf::io {
namespace {

using nlohmann::json;
using test::complaint;
using test::GltfWriter;
using test::TemporaryFolder;
using test::write;
using testing::HasSubstr;

/// One thing is wrong with the letter.
struct Case {
  const char* label;
  void (*spoil)(json& gltf);
  const char* place;   ///< named in the message
  const char* reason;  ///< named in the message
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.label; }

const std::vector<Case>& broken() {
  static const std::vector<Case> all{
      {"no_asset", [](json& g) { g.erase("asset"); }, "a.glb", "'asset' is missing"},
      {"node_missing",
       [](json& g) {
         g["scenes"] = {{{"nodes", {3}}}};
       },
       "a.glb", "nodes[3]"},
      {"scene_missing",
       [](json& g) {
         g["scenes"] = {json::object()};
         g["scene"] = 1;
       },
       "a.glb", "scenes[1]"},
      {"mesh_missing", [](json& g) { g["nodes"][0]["mesh"] = 1; }, "a.glb", "meshes[1]"},
      {"accessor_missing", [](json& g) { g["accessors"].erase(1); }, "a.glb", "accessors[1]"},
      {"view_missing", [](json& g) { g["accessors"][0]["bufferView"] = 7; }, "a.glb",
       "bufferViews[7]"},
      {"material_missing", [](json& g) { g["meshes"][0]["primitives"][0]["material"] = 0; },
       "a.glb", "materials[0]"},
      {"nodes_no_array", [](json& g) { g["nodes"] = 3; }, "nodes", "an array"},
      {"node_no_object", [](json& g) { g["nodes"][0] = 3; }, "nodes[0]", "an object"},
      {"loop",
       [](json& g) {
         g["nodes"][0]["children"] = {0};
         g["scenes"] = {{{"nodes", {0}}}};
       },
       "nodes[0]", "child of two nodes"},
      {"only_loop", [](json& g) { g["nodes"][0]["children"] = {0}; }, "a.glb", "no triangles"},
      {"matrix_short",
       [](json& g) {
         g["nodes"][0]["matrix"] = {1, 2};
       },
       "nodes[0].matrix", "16"},
      {"matrix_row",
       [](json& g) { g["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
       "nodes[0].matrix", "last row"},
      {"rotation_zero",
       [](json& g) {
         g["nodes"][0]["rotation"] = {0, 0, 0, 0};
       },
       "nodes[0].rotation", "quaternion"},
      {"scale_text",
       [](json& g) {
         g["nodes"][0]["scale"] = {"1", 1, 1};
       },
       "nodes[0].scale[0]", "finite number"},
      {"scale_huge",
       [](json& g) {
         g["nodes"][0]["scale"] = {1e308, 1e308, 1e308};
       },
       "a.glb", "too large"},
      {"index_too_high", [](json& g) { g["accessors"][0]["count"] = 3; }, "primitives[0]",
       "from 0 to 2"},
      {"not_whole", [](json& g) { g["accessors"][1]["count"] = 4; }, "primitives[0]", "4 corners"},
      {"count_too_high", [](json& g) { g["accessors"][0]["count"] = 4000; }, "accessors[0]",
       "do not fit"},
      {"count_negative", [](json& g) { g["accessors"][0]["count"] = -1; }, "accessors[0].count",
       "whole number"},
      {"count_huge", [](json& g) { g["accessors"][0]["count"] = 1e15; }, "nodes[0]", "too many"},
      {"component", [](json& g) { g["accessors"][0]["componentType"] = 5124; }, "accessors[0]",
       "5124"},
      {"float_indices", [](json& g) { g["accessors"][1]["componentType"] = 5126; }, "accessors[1]",
       "unsigned"},
      {"vec2", [](json& g) { g["accessors"][0]["type"] = "VEC2"; }, "accessors[0]", "'VEC2'"},
      {"offset_high", [](json& g) { g["accessors"][0]["byteOffset"] = 100000; }, "accessors[0]",
       "100000"},
      {"view_high", [](json& g) { g["bufferViews"][0]["byteLength"] = 100000; }, "bufferViews[0]",
       "outside"},
      {"view_overflow", [](json& g) { g["bufferViews"][0]["byteOffset"] = 9007199254740992; },
       "bufferViews[0]", "outside"},
      {"stride_low", [](json& g) { g["bufferViews"][0]["byteStride"] = 4; }, "accessors[0]",
       "4 bytes apart"},
      {"no_data", [](json& g) { g["accessors"][0].erase("bufferView"); }, "accessors[0]",
       "no data"},
      {"mode", [](json& g) { g["meshes"][0]["primitives"][0]["mode"] = 7; }, "primitives[0]",
       "mode 7"},
      {"only_points", [](json& g) { g["meshes"][0]["primitives"][0]["mode"] = 0; }, "a.glb",
       "no triangles"},
  };
  return all;
}

std::string complaint_about(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  return complaint<FileError>([&] { read_mesh(write(folder.path() / name, content)); });
}

class BrokenGltf : public testing::TestWithParam<Case> {};

TEST_P(BrokenGltf, IsRefusedWithPlaceAndReason) {
  GltfWriter gltf = test::gltf_of_f();
  GetParam().spoil(gltf.json);
  const std::string text = complaint_about("a.glb", gltf.glb());
  EXPECT_THAT(text, HasSubstr("a.glb"));
  EXPECT_THAT(text, HasSubstr(GetParam().place));
  EXPECT_THAT(text, HasSubstr(GetParam().reason));
}

INSTANTIATE_TEST_SUITE_P(Cases, BrokenGltf, testing::ValuesIn(broken()),
                         [](const auto& test) { return std::string(test.param.label); });

TEST(GltfFileErrors, PositionsMustBeFinite) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.binary.replace(12, 4, test::bytes(std::nanf(""), false));
  EXPECT_THAT(complaint_about("a.glb", gltf.glb()), HasSubstr("vertex 1 is not finite"));
}

TEST(GltfFileErrors, DamagedContainers) {
  const std::string good = test::gltf_of_f().glb();
  EXPECT_THAT(complaint_about("a.glb", good.substr(0, 10)), HasSubstr("ends within its header"));
  EXPECT_THAT(complaint_about("a.glb", good.substr(0, good.size() - 1)), HasSubstr("announces"));
  std::string spoilt = good;
  EXPECT_THAT(complaint_about("a.glb", spoilt.replace(16, 4, "XXXX")), HasSubstr("not JSON"));
  spoilt = good;
  EXPECT_THAT(complaint_about("a.glb", spoilt.replace(12, 4, "\xff\xff\xff\xff")),
              HasSubstr("beyond the end"));
  spoilt = good;
  EXPECT_THAT(complaint_about("a.glb", spoilt.replace(20, 1, "!")), HasSubstr("JSON is broken"));
  EXPECT_THAT(complaint_about("a.gltf", "[]"), HasSubstr("not an object"));
  EXPECT_THAT(complaint_about("a.gltf", "{\"a\": 1e999}"), HasSubstr("JSON is broken"));
}

TEST(GltfFileErrors, DataElsewhere) {
  const GltfWriter gltf = test::gltf_of_f();
  EXPECT_THAT(complaint_about("a.gltf", gltf.text("none.bin")), HasSubstr("none.bin"));
  for (const char* uri : {"http://example.org/a.bin", "/dev/zero", "file:///a.bin"}) {
    EXPECT_THAT(complaint_about("a.gltf", gltf.text(uri)), HasSubstr("not beside the file"));
  }
  for (const char* uri : {"data:;base64,A", "data:;base64,A*==", "data:text,abc", "data:"}) {
    EXPECT_THAT(complaint_about("a.gltf", gltf.text(uri)), HasSubstr("not base64"));
  }
  EXPECT_THAT(complaint_about("a.gltf", gltf.text("data:;base64,AAAA")), HasSubstr("there are 3"));
  const TemporaryFolder folder;
  write(folder.path() / "a.bin", "short");
  const auto path = write(folder.path() / "a.gltf", gltf.text("a.bin"));
  EXPECT_THAT(complaint<FileError>([&] { read_mesh(path); }), HasSubstr("has 5 bytes"));
}

TEST(GltfErrors, BuffersLieInOrBelowTheFolder) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const GltfWriter gltf = test::gltf_of_f();
  const fs::path inside = folder.path() / "inside", path = inside / "a.gltf";
  fs::create_directories(inside / "deep");
  write(folder.path() / "out.bin", gltf.binary);
  write(inside / "a b.bin", gltf.binary);
  write(inside / "deep" / "c.bin", gltf.binary);
  fs::create_symlink("../out.bin", inside / "link.bin");
  fs::create_symlink("..", inside / "up");
  fs::create_symlink("deep/c.bin", inside / "near.bin");
  for (const char* uri : {"../out.bin", "%2e%2e/out.bin", "deep/../../out.bin", "%2Fetc/passwd",
                          "link.bin", "up/out.bin", "up/inside/../out.bin"}) {
    write(path, gltf.text(uri));
    EXPECT_THAT(complaint<FileError>([&] { read_mesh(path); }),
                HasSubstr("not in or below the folder"))
        << uri;
    EXPECT_THAT(complaint<FileError>([&] { mesh_input_files(path); }),
                HasSubstr("not in or below the folder"))
        << uri;
  }
  for (const char* uri :
       {"a%20b.bin", "./deep/c.bin", "deep/../deep/c.bin", "near.bin", "up/inside/a%20b.bin"}) {
    write(path, gltf.text(uri));
    EXPECT_NO_THROW(read_mesh(path)) << uri;
  }
  fs::create_symlink("inside/a.gltf",
                     folder.path() / "a.gltf");  // what lies beside the file itself is near, too
  fs::create_symlink("inside/near.bin", folder.path() / "near.bin");
  write(path, gltf.text("near.bin"));
  EXPECT_NO_THROW(read_mesh(folder.path() / "a.gltf"));
}

std::string unsupported(const GltfWriter& gltf) {
  const TemporaryFolder folder;
  return complaint<Unsupported>([&] { read_mesh(write(folder.path() / "a.glb", gltf.glb())); });
}

TEST(GltfFileErrors, CompressionIsNotSupported) {
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    GltfWriter gltf = test::gltf_of_f();
    gltf.json["extensionsRequired"] = {name};
    EXPECT_THAT(unsupported(gltf),
                testing::AllOf(HasSubstr(name), HasSubstr("without compression")));
  }
  GltfWriter gltf = test::gltf_of_f();
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {};
  gltf.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(unsupported(gltf), HasSubstr("Draco"));
  gltf = test::gltf_of_f();
  gltf.json["bufferViews"][0]["buffer"] = 1;
  gltf.json["buffers"] = {{{"byteLength", 1}}, {{"byteLength", 1}}};
  const TemporaryFolder folder;
  const auto path =
      write(folder.path() / "a.glb", GltfWriter::container(gltf.json.dump(), gltf.binary));
  EXPECT_THAT(complaint<Unsupported>([&] { read_mesh(path); }), HasSubstr("without compression"));
}

TEST(GltfFileErrors, OtherVersionsAndExtensionsAreNotSupported) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.json["asset"]["version"] = "1.0";
  EXPECT_THAT(unsupported(gltf), HasSubstr("'1.0'"));
  gltf = test::gltf_of_f();
  gltf.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  EXPECT_THAT(unsupported(gltf), HasSubstr("EXT_mesh_gpu_instancing"));
  const TemporaryFolder folder;
  std::string version_1 = test::gltf_of_f().glb();
  const auto path = write(folder.path() / "a.glb", version_1.replace(4, 1, "\1"));
  EXPECT_THAT(complaint<Unsupported>([&] { read_mesh(path); }), HasSubstr("version 1"));
}

TEST(GltfFileErrors, SkeletonsAndShapeKeysAreNotSupported) {
  GltfWriter gltf = test::gltf_of_f();
  gltf.json["nodes"][0]["skin"] = 0;
  EXPECT_THAT(unsupported(gltf), testing::AllOf(HasSubstr("nodes[0]"), HasSubstr("skeleton")));
  gltf = test::gltf_of_f();
  gltf.json["meshes"][0]["weights"] = {0, 0.5};
  EXPECT_THAT(unsupported(gltf), HasSubstr("shape keys"));
  gltf.json["nodes"][0]["weights"] = {0, 0};  // the node's own count
  const TemporaryFolder folder;
  EXPECT_NO_THROW(read_mesh(write(folder.path() / "a.glb", gltf.glb())));
}

TEST(GltfFileErrors, ASmallFileCannotFillTheMemory) {
  GltfWriter gltf = test::gltf_of_f();
  json& accessor = gltf.json["accessors"][0];
  accessor.erase("bufferView");
  accessor["count"] = 1 << 27;
  accessor["sparse"] = {{"count", 0}};
  EXPECT_THAT(complaint_about("a.glb", gltf.glb()), HasSubstr("no data"));

  gltf = test::gltf_of_f();
  const int many = gltf.add_view(std::string(3 << 16, '\0'));
  gltf.json["accessors"][0].update(
      {{"bufferView", many}, {"componentType", test::gltf_uint8}, {"count", 1 << 16}});
  for (int i = 0; i < 5000; ++i) gltf.add_node({{"mesh", 0}, {"name", std::to_string(i)}});
  EXPECT_THAT(complaint_about("a.glb", gltf.glb()), HasSubstr("too many triangles"));
}

}  // namespace
}  // namespace surf::io
