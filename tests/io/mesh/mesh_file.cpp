// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/mesh_file.h"

#include "io_test.h"
#include "letter_f_mesh.h"
#include "surf/mesh/check_mesh.h"

namespace surf::io {
namespace {

using test::bytes;
using test::corners;
using test::QuadMesh;
using test::TemporaryFolder;
using test::write;

/// Reads a file of this name and content.
TriangleMesh read_text(const std::string& name, const std::string& content, double unit_nm = 1) {
  const TemporaryFolder folder;
  return read_mesh(write(folder.path() / name, content), unit_nm);
}

void expect_letter_f(const std::string& name, const std::string& content) {
  SCOPED_TRACE(name);
  const TriangleMesh expected = test::letter_f_triangles();
  const TriangleMesh mesh = read_text(name, content);
  EXPECT_EQ(corners(mesh), corners(expected));
  EXPECT_EQ(mesh.vertices_nm.size(), expected.vertices_nm.size());
}

std::string obj_of_f() {
  const QuadMesh f = test::letter_f_quads();
  std::string text = "\xEF\xBB\xBF# a comment\r\nmtllib f.mtl\r\no F\r\n";
  for (const Vec3& v : f.vertices) text += fmt::format("v {} \\\n {} +{}\r\n", v.x, v.y, v.z);
  text += "vt 0 0\nvn 0 0 1\ng side\nusemtl grey\ns off\n";
  const auto count = static_cast<int>(f.vertices.size());
  int style = 0;
  for (const auto& q : f.quads) {
    text += "f";
    for (const std::uint32_t c : q) {
      switch (style % 5) {
        case 0:
          text += fmt::format(" {}", c + 1);
          break;
        case 1:
          text += fmt::format("\t{}/1", c + 1);
          break;
        case 2:
          text += fmt::format(" {}//1", c + 1);
          break;
        case 3:
          text += fmt::format(" {}/1/1 \\\n", c + 1);
          break;
        default:
          text += fmt::format(" {}/-1/-1", static_cast<int>(c) - count);
      }
    }
    text += ++style % 2 ? " # after\n\n" : "\n";
  }
  return text;
}

std::string off_of_f(const std::string& keyword, const std::string& extras) {
  const QuadMesh f = test::letter_f_quads();
  std::string text =
      fmt::format("# first\n{}\n# second\n{} {} 0\n\n", keyword, f.vertices.size(), f.quads.size());
  for (const Vec3& v : f.vertices) text += fmt::format("{} {} {}{}\n", v.x, v.y, v.z, extras);
  for (const auto& q : f.quads) {
    text += fmt::format("4  {} {} {} {}  0.5 0.5 0.5 # grey\n", q[0], q[1], q[2], q[3]);
  }
  return text;
}

std::string text_ply_of_f() {
  const QuadMesh f = test::letter_f_quads();
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex {}\nproperty uchar red\n"
      "property float z\nproperty double x\nproperty float32 y\nelement face {}\n"
      "property list uchar int vertex_index\nproperty list uint8 float texcoord\nend_header\n",
      f.vertices.size(), f.quads.size());
  for (const Vec3& v : f.vertices) text += fmt::format("255 {} {} {}\n", v.z, v.x, v.y);
  for (const auto& q : f.quads) {
    text += fmt::format("4 {} {} {} {} 2 0 nan\n", q[0], q[1], q[2], q[3]);
  }
  return text;
}

/// Every scalar type occurs, vertices after faces, and an element that nobody knows.
template <class Index>
std::string binary_ply_of_f(bool big, const std::string& index_type) {
  const QuadMesh f = test::letter_f_quads();
  std::string text = fmt::format(
      "ply\r\nformat binary_{}_endian 1.0\r\nobj_info x\r\nelement face {}\r\nproperty short a\r\n"
      "property list ushort {} vertex_indices\r\nproperty char b\r\nelement extra 2\r\n"
      "property list uint double values\r\nelement vertex {}\r\nproperty float x\r\n"
      "property double y\r\nproperty float z\r\nproperty int quality\r\nend_header\r\n",
      big ? "big" : "little", f.quads.size(), index_type, f.vertices.size());
  for (const auto& q : f.quads) {
    text += bytes(std::int16_t{-1}, big) + bytes(std::uint16_t{4}, big);
    for (const std::uint32_t c : q) text += bytes(static_cast<Index>(c), big);
    text += bytes(std::int8_t{3}, big);
  }
  text += bytes(std::uint32_t{0}, big) + bytes(std::uint32_t{1}, big) + bytes(1.5, big);
  for (const Vec3& v : f.vertices) {
    text += bytes(static_cast<float>(v.x), big) + bytes(v.y, big) +
            bytes(static_cast<float>(v.z), big) + bytes(std::int32_t{7}, big);
  }
  return text;
}

TEST(MeshFile, TheLetterIsClosed) {
  EXPECT_TRUE(check_mesh(test::letter_f_triangles()).closed_and_oriented);
  EXPECT_GT(check_mesh(test::letter_f_triangles()).signed_volume_nm3, 0);
}

TEST(MeshFile, ReadsStl) {
  const TriangleMesh f = test::letter_f_triangles();
  expect_letter_f("f.stl", test::text_stl(f));
  expect_letter_f("f.STL", test::binary_stl(f));
}

TEST(MeshFile, ReadsStlOfSeveralSolidsInCapitals) {
  std::string text = test::text_stl(test::letter_f_triangles());
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  expect_letter_f("f.stl", "solid\nendsolid\n" + text);
}

TEST(MeshFile, ReadsObj) { expect_letter_f("f.obj", obj_of_f()); }

TEST(MeshFile, ReadsOff) {
  expect_letter_f("f.off", off_of_f("OFF", ""));
  expect_letter_f("f.off", off_of_f("COFF", " 255 0 0 255"));
  expect_letter_f("f.off", off_of_f("NOFF", " 0 0 1"));
  expect_letter_f("f.off", off_of_f("STCNOFF", " 0 0 1 0.5 0.5 0.5 1 0 0"));
  expect_letter_f("f.off", off_of_f("", ""));
}

TEST(MeshFile, ReadsPly) {
  expect_letter_f("f.ply", text_ply_of_f());
  for (const bool big : {false, true}) {
    expect_letter_f("f.ply", binary_ply_of_f<std::int8_t>(big, "char"));
    expect_letter_f("f.ply", binary_ply_of_f<std::uint8_t>(big, "uint8"));
    expect_letter_f("f.ply", binary_ply_of_f<std::int16_t>(big, "int16"));
    expect_letter_f("f.ply", binary_ply_of_f<std::uint16_t>(big, "ushort"));
    expect_letter_f("f.ply", binary_ply_of_f<std::int32_t>(big, "int"));
    expect_letter_f("f.ply", binary_ply_of_f<std::uint32_t>(big, "uint32"));
  }
}

TEST(MeshFile, ContentCountsMoreThanTheName) {
  const TriangleMesh f = test::letter_f_triangles();
  expect_letter_f("f.obj", test::binary_stl(f));
  expect_letter_f("f.bin", test::text_stl(f));
  expect_letter_f("f.stl", text_ply_of_f());
  expect_letter_f("f.ply", off_of_f("OFF", ""));
}

TEST(MeshFile, ScalesByTheUnit) {
  const auto mesh = read_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 0.5 0\nf 1 2 3\n", 1000);
  EXPECT_EQ(mesh.vertices_nm.at(1), (Vec3{1000, 0, 0}));
  EXPECT_EQ(mesh.vertices_nm.at(2), (Vec3{0, 500, 0}));
}

TEST(MeshFile, KeepsEveryDigit) {
  const auto mesh =
      read_text("a.off",
                "OFF\n3 1 0\n0.1 1e-400 -0\n1.7976931348623157e308 0 0\n0 .3333333333333333 0\n"
                "3 0 1 2\n");
  EXPECT_EQ(mesh.vertices_nm.at(0), (Vec3{0.1, 0, 0}));
  EXPECT_EQ(mesh.vertices_nm.at(1).x, 1.7976931348623157e308);
  EXPECT_EQ(mesh.vertices_nm.at(2).y, 0.3333333333333333);
}

TEST(MeshFile, FansPolygonsAndMergesVertices) {
  const auto mesh = read_text("a.obj",
                              "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nv 0 0 0\nv 9 9 9\n"
                              "f 1 2 3 4 5\nf 6 3 2\n");
  const std::vector<Triangle> expected{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 2, 1}};
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.vertices_nm.size(), 5u);
}

TEST(MeshFile, ObjMaterialsMakeBodies) {
  const TemporaryFolder folder;
  const auto path = write(folder.path() / "part.obj",
                          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\no cone\nusemtl old gold\n"
                          "f 1 2 4\nusemtl none\nusemtl grey\nf 2 3 4\no ball\nf 1 3 4\n"
                          "usemtl old  gold # again\no cone\nf 4 3 2\n");
  const auto meshes = read_meshes(path);
  ASSERT_EQ(meshes.size(), 3u);
  const auto expect_body = [&](std::size_t i, const char* name, const char* material,
                               std::vector<Triangle> triangles) {
    EXPECT_EQ(meshes[i].name, name);
    EXPECT_EQ(meshes[i].material, material);
    TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, std::move(triangles)};
    EXPECT_EQ(corners(meshes[i].mesh), corners(expected));
  };
  expect_body(0, "part", "", {{0, 1, 2}});
  expect_body(1, "cone", "old gold", {{0, 1, 3}, {3, 2, 1}});
  expect_body(2, "part", "grey", {{1, 2, 3}, {0, 2, 3}});  // faces of two objects
  EXPECT_EQ(meshes[0].mesh.vertices_nm.size(), 3u);
  EXPECT_EQ(read_mesh(path).vertices_nm.size(), 4u) << "joined, with shared vertices";
  EXPECT_EQ(read_mesh(path).triangles.size(), 5u);
}

TEST(MeshFile, OtherFormatsAreOneBodyNamedByTheFile) {
  const TemporaryFolder folder;
  const auto path =
      write(folder.path() / "my part.v2.stl", test::binary_stl(test::letter_f_triangles()));
  const auto meshes = read_meshes(path);
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "my part.v2");
  EXPECT_EQ(meshes[0].material, "");
}

TEST(MeshFile, KnowsItsExtensions) {
  for (const char* name :
       {"a.stl", "a.STL", "b/a.Obj", "a.ply", "a.off", "a.glb", "a.gltf", "a.vtp"}) {
    EXPECT_TRUE(is_mesh_file(name));
  }
  for (const char* name : {"a.toml", "stl", "a.stl/b", "a.exr", ""}) {
    EXPECT_FALSE(is_mesh_file(name));
  }
}

TEST(MeshFile, KnowsItsContentUnderAnyName) {
  const TemporaryFolder folder;
  EXPECT_TRUE(has_mesh_content(
      write(folder.path() / "part.bin", test::binary_stl(test::letter_f_triangles()))));
  EXPECT_FALSE(has_mesh_content(write(folder.path() / "part.stl", "nothing of the kind")));
  EXPECT_FALSE(has_mesh_content(folder.path() / "missing"));
}

}  // namespace
}  // namespace surf::io
