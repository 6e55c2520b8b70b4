// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "io_test.h"
#include "letter_f_mesh.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"

namespace surf::io {
namespace {

using test::complaint;
using test::corners;
using test::TemporaryFolder;
using testing::HasSubstr;

/// Names of all formats that this build writes; of all but STL, which does not keep every digit.
std::vector<std::string> names(bool with_stl) {
  std::vector<std::string> result{"f.obj", "f.PLY", "f.off"};
  if (with_stl) result.push_back("f.stl");
  if (image_library_versions().find("VTK") != std::string::npos) result.push_back("f.vtp");
  return result;
}

/// The letter with coordinates that take all digits: thirds, huge, tiny and negative ones.
TriangleMesh awkward_letter() {
  TriangleMesh mesh = test::letter_f_triangles();
  for (Vec3& v : mesh.vertices_nm) v = {v.x / 3 - 0.1, (v.y + 0.1) * 1e17, -(v.z + 0.7) * 1e-300};
  return mesh;
}

TriangleMesh written_and_read(const std::string& name, const TriangleMesh& mesh,
                              double unit_nm = 1) {
  const TemporaryFolder folder;
  write_mesh(folder.path() / name, mesh, unit_nm);
  EXPECT_EQ(test::files_in(folder.path()), 1);
  return read_mesh(folder.path() / name, unit_nm);
}

TEST(WriteMesh, EveryFormatKeepsTheLetter) {
  const TriangleMesh mesh = test::letter_f_triangles();
  for (const std::string& name : names(true)) {
    SCOPED_TRACE(name);
    const TriangleMesh read = written_and_read(name, mesh);
    EXPECT_EQ(corners(read), corners(mesh));
    EXPECT_EQ(read.vertices_nm.size(), mesh.vertices_nm.size());
  }
}

TEST(WriteMesh, AllButStlKeepEveryDigitAndTheOrder) {
  const TriangleMesh mesh = awkward_letter();
  for (const std::string& name : names(false)) {
    SCOPED_TRACE(name);
    const TriangleMesh read = written_and_read(name, mesh);
    EXPECT_EQ(read.vertices_nm, mesh.vertices_nm);
    EXPECT_EQ(read.triangles, mesh.triangles);
  }
}

TEST(WriteMesh, StlKeepsTwentyFourBits) {
  TriangleMesh mesh = test::letter_f_triangles();
  for (Vec3& v : mesh.vertices_nm) v = {v.x / 3, v.y / 7, v.z / 11 + 1e4};
  const auto expected = corners(mesh);
  const auto read = corners(written_and_read("f.stl", mesh));
  ASSERT_EQ(read.size(), expected.size());
  for (std::size_t t = 0; t < read.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(read[t][c].x, double{static_cast<float>(expected[t][c].x)});
      EXPECT_EQ(read[t][c].y, double{static_cast<float>(expected[t][c].y)});
      EXPECT_EQ(read[t][c].z, double{static_cast<float>(expected[t][c].z)});
    }
  }
}

TEST(WriteMesh, StlHasOutwardNormalsAndDoesNotLookLikeText) {
  const TemporaryFolder folder;
  const TriangleMesh one{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {4, 0, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  write_mesh(folder.path() / "a.stl", one);
  const std::string content = test::content_of(folder.path() / "a.stl");
  ASSERT_EQ(content.size(), 84u + 2 * 50);
  EXPECT_FALSE(content.starts_with("solid"));
  const auto zero = test::bytes(0.F, false), up = test::bytes(1.F, false);
  EXPECT_EQ(content.substr(84, 12), zero + zero + up);
  EXPECT_EQ(content.substr(84 + 50, 12), zero + zero + zero) << "a triangle without area";
}

TEST(WriteMesh, DividesByTheUnitAndSaysSo) {
  const TriangleMesh mesh{{{0, 0, 0}, {2000, 0, 0}, {0, 500, 0}}, {{0, 1, 2}}};
  const TemporaryFolder folder;
  for (const std::string& name : names(true)) {
    SCOPED_TRACE(name);
    write_mesh(folder.path() / name, mesh, 1000);
    const TriangleMesh numbers = read_mesh(folder.path() / name, {1.0, true});
    EXPECT_EQ(numbers.vertices_nm.at(1), (Vec3{2, 0, 0}));
    EXPECT_EQ(numbers.vertices_nm.at(2), (Vec3{0, 0.5, 0}));
    EXPECT_EQ(read_mesh(folder.path() / name).vertices_nm, mesh.vertices_nm);
  }
}

TEST(WriteMesh, RefusesWhatCannotBeReadAgain) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.ply";
  const TriangleMesh good = test::letter_f_triangles();
  const double nan = std::nan("");
  EXPECT_THAT(complaint<InvalidInput>([&] { write_mesh(path, {}); }), HasSubstr("no triangles"));
  EXPECT_THAT(complaint<InvalidInput>([&] {
                write_mesh(path, {{{0, 0, 0}, {nan, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}});
              }),
              HasSubstr("vertex 1"));
  EXPECT_THAT(complaint<InvalidInput>([&] {
                write_mesh(path, {{{0, 0, 0}}, {{0, 0, 1}}});
              }),
              HasSubstr("corner 1"));
  EXPECT_THAT(complaint<InvalidInput>([&] {
                write_mesh(folder.path() / "a.stl", {{{0, 0, 0}, {1e39, 0, 0}}, {{0, 1, 1}}});
              }),
              HasSubstr("1e+39"));
  EXPECT_THAT(complaint<InvalidInput>([&] { write_mesh(path, good, 1e-310); }),
              HasSubstr("too large"));
  for (const double unit : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(complaint<UsageError>([&] { write_mesh(path, good, unit); }), HasSubstr("unit"));
  }
  EXPECT_EQ(test::files_in(folder.path()), 0);
}

TEST(WriteMesh, TargetsAreCheckedEarly) {
  const TemporaryFolder folder;
  const auto& root = folder.path();
  for (const char* name : {"a.jpg", "a", "a.toml", "a.step"}) {
    EXPECT_THAT(complaint<UsageError>([&] { check_mesh_target(root / name); }),
                HasSubstr("not written"));
    EXPECT_THAT(complaint<UsageError>([&] { write_mesh(root / name, test::letter_f_triangles()); }),
                HasSubstr(".stl"));
  }
  std::filesystem::create_directory(root / "b.stl");
  EXPECT_THAT(complaint<FileError>([&] { check_mesh_target(root / "b.stl"); }),
              HasSubstr("folder"));
  check_mesh_target(root / "new" / "c.off");
  EXPECT_EQ(test::files_in(root / "new"), 0) << "only the folder is made";
}

}  // namespace
}  // namespace surf::io
