// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/surface_file.h"

#include "io_test.h"
#include "surf/io/mesh_file.h"
#include "surface_scenes.h"

namespace surf::io {
namespace {

using test::corners;
using test::is_float32;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

/// The scene with what the format holds, and a single surface where it knows no more.
SurfaceScene as_far_as(const SurfaceFormat& format, SurfaceScene scene) {
  if (!format.several) scene.surfaces.resize(1);
  for (Surface& surface : scene.surfaces) {
    if (!format.scalars) surface.scalars.clear();
    if (!format.drape) surface.drape.reset();
  }
  if (!format.tracks) scene.tracks.clear();
  return scene;
}

/// The corners of the triangles in nm, equal to within `allowed_nm`.
void expect_same_corners(const TriangleMesh& read, const TriangleMesh& written, double allowed_nm) {
  const auto a = corners(read), b = corners(written);
  ASSERT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, length(a[t][c] - b[t][c]));
  }
  EXPECT_LE(largest, allowed_nm);
}

void expect_same_scalars(const Surface& read, const Surface& written) {
  ASSERT_EQ(read.scalars.size(), written.scalars.size());
  for (const VertexScalar& expected : written.scalars) {
    const auto found = std::find_if(read.scalars.begin(), read.scalars.end(),
                                    [&](const VertexScalar& s) { return s.name == expected.name; });
    ASSERT_NE(found, read.scalars.end()) << expected.name;
    EXPECT_EQ(found->unit, expected.unit);
    EXPECT_EQ(found->values, expected.values);
  }
}

void expect_same_drape(const Surface& read, const Surface& written) {
  ASSERT_EQ(read.drape.has_value(), written.drape.has_value());
  if (!read.drape) return;
  EXPECT_EQ(read.drape->name, written.drape->name);
  EXPECT_EQ(read.drape->grey, written.drape->grey);
  EXPECT_DOUBLE_EQ(read.drape->pitch_x_nm, written.drape->pitch_x_nm);
  EXPECT_DOUBLE_EQ(read.drape->pitch_y_nm, written.drape->pitch_y_nm);
  EXPECT_DOUBLE_EQ(read.drape->origin_x_nm, written.drape->origin_x_nm);
  EXPECT_DOUBLE_EQ(read.drape->origin_y_nm, written.drape->origin_y_nm);
}

TEST(SurfaceFile, EveryFormatGivesBackWhatItHolds) {
  for (const SurfaceFormat& format : test::written_formats()) {
    SCOPED_TRACE(format.extension);
    const TemporaryFolder folder;
    const auto path = folder.path() / ("a b" + std::string(format.extension));
    const SurfaceScene written = as_far_as(format, test::two_letters());
    write_surfaces(path, written);
    const SurfaceScene read = read_surfaces(path);
    ASSERT_EQ(read.surfaces.size(), written.surfaces.size());
    for (std::size_t s = 0; s < read.surfaces.size(); ++s) {
      SCOPED_TRACE(s);
      const Surface& got = read.surfaces[s];
      const Surface& expected = written.surfaces[s];
      if (is_float32(format)) {
        expect_same_corners(got.mesh, expected.mesh, 1e-5);  // of 100 nm
      } else {
        EXPECT_EQ(got.mesh.vertices_nm, expected.mesh.vertices_nm);
        EXPECT_EQ(got.mesh.triangles, expected.mesh.triangles);
      }
      EXPECT_EQ(got.name, format.extension == ".stl" ? "a b" : expected.name);
      expect_same_scalars(got, expected);
      expect_same_drape(got, expected);
    }
    ASSERT_EQ(read.tracks.size(), written.tracks.size());
    for (std::size_t t = 0; t < read.tracks.size(); ++t) {
      ASSERT_EQ(read.tracks[t].points_nm.size(), written.tracks[t].points_nm.size());
      const double allowed_nm = is_float32(format) ? 1e-5 : 0;
      for (std::size_t p = 0; p < read.tracks[t].points_nm.size(); ++p) {
        EXPECT_LE(length(read.tracks[t].points_nm[p] - written.tracks[t].points_nm[p]), allowed_nm);
      }
      EXPECT_EQ(read.tracks[t].energy_ev, written.tracks[t].energy_ev) << "whole halves of eV";
      EXPECT_EQ(read.tracks[t].material, written.tracks[t].material);
      EXPECT_EQ(read.tracks[t].kind, written.tracks[t].kind);
      EXPECT_EQ(read.tracks[t].electron, written.tracks[t].electron);
      EXPECT_EQ(read.tracks[t].parent, written.tracks[t].parent);
      EXPECT_EQ(read.tracks[t].secondary, written.tracks[t].secondary);
    }
    if (format.extension == ".stl") continue;  // 80 bytes do not hold all
    EXPECT_EQ(read.metadata, written.metadata);
  }
}

TEST(SurfaceFile, MagnificationAndExaggerationAreUndone) {
  for (const SurfaceFormat& format : test::written_formats()) {
    for (const Magnification& m : {Magnification{1, 1}, Magnification{1e6, 5},
                                   Magnification{3.7e5, 1}, Magnification{3.7e5, 0.3}}) {
      SCOPED_TRACE(fmt::format("{} {} {}", format.extension, m.factor, m.z_exaggeration));
      const TemporaryFolder folder;
      const auto path = folder.path() / ("f" + std::string(format.extension));
      SurfaceScene scene;
      scene.surfaces = {test::letter_surface("F", 0)};
      write_surfaces(path, scene, m);
      const double allowed_nm = is_float32(format) ? 1e-5 : 1e-13;
      expect_same_corners(read_surfaces(path).surfaces.at(0).mesh, scene.surfaces[0].mesh,
                          allowed_nm);
      expect_same_corners(read_mesh(path), scene.surfaces[0].mesh, allowed_nm);
    }
  }
}

TEST(SurfaceFile, TheNumbersInTheFileAreMillimetresOfTheMagnifiedBody) {
  const TemporaryFolder folder;
  SurfaceScene scene;
  scene.surfaces = {{"t", {{{0, 0, 0}, {200, 0, 0}, {0, 400, 80}}, {{0, 1, 2}}}, {}, {}}};
  write_surfaces(folder.path() / "a.obj", scene, {.factor = 5e5, .z_exaggeration = 3});
  EXPECT_THAT(test::content_of(folder.path() / "a.obj"), HasSubstr("\nv 0 200 120\n"));
  write_surfaces(folder.path() / "b.obj", scene, {.factor = 1});
  EXPECT_THAT(test::content_of(folder.path() / "b.obj"), HasSubstr("\nv 0 0.0004 8e-05\n"));
  write_surfaces(folder.path() / "c.off", scene, {.factor = 5e5, .z_exaggeration = 3});
  EXPECT_THAT(test::content_of(folder.path() / "c.off"), HasSubstr("\n0 400 80\n"))
      << "it holds nm";
}

TEST(SurfaceFile, AUnitThatOverridesTakesThePlaceOfTheMagnification) {
  for (const SurfaceFormat& format : test::written_formats()) {
    if (format.extension == ".glb" || format.extension == ".gltf" || format.extension == ".3mf")
      continue;
    SCOPED_TRACE(format.extension);
    const TemporaryFolder folder;
    const auto path = folder.path() / ("f" + std::string(format.extension));
    SurfaceScene scene;
    scene.surfaces = {{"t", {{{0, 0, 0}, {200, 0, 0}, {0, 400, 80}}, {{0, 1, 2}}}, {}, {}}};
    write_surfaces(path, scene, {.factor = 5e5, .z_exaggeration = 2});
    const double shrunk = format.magnified ? 0.5 : 1;
    const Vec3 expected{0, 400 * 10 * shrunk, 80 * 10 * shrunk};
    EXPECT_LE(
        length(read_surfaces(path, {10.0, true}).surfaces.at(0).mesh.vertices_nm.at(2) - expected),
        1e-9);
  }
}

TEST(SurfaceFile, FilesOfOthersStayInNm) {
  const TemporaryFolder folder;
  const TriangleMesh letter = test::letter_f_triangles();
  test::write(folder.path() / "old.stl", test::binary_stl(letter));
  EXPECT_EQ(corners(read_surfaces(folder.path() / "old.stl").surfaces.at(0).mesh), corners(letter));
  EXPECT_EQ(corners(read_mesh(folder.path() / "old.stl", 1000.0))[0][1],
            corners(letter)[0][1] * 1000);
}

TEST(SurfaceFile, SeveralBecomeOneWhereTheFormatHasOne) {
  for (const char* name : {"f.stl", "f.ply", "f.off"}) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    SurfaceScene scene = test::two_letters();
    scene.surfaces[1].scalars.pop_back();
    write_surfaces(folder.path() / name, scene);
    const SurfaceScene read = read_surfaces(folder.path() / name);
    ASSERT_EQ(read.surfaces.size(), 1u);
    const auto got = corners(read.surfaces[0].mesh);
    const auto first = corners(scene.surfaces[0].mesh), second = corners(scene.surfaces[1].mesh);
    ASSERT_EQ(got.size(), first.size() + second.size());
    EXPECT_LE(length(got[first.size()][2] - second[0][2]), 1e-5);
    EXPECT_EQ(read.surfaces[0].name, "f");
    if (name != std::string("f.ply")) continue;
    ASSERT_EQ(read.surfaces[0].scalars.size(), 2u) << "those that both have";
    EXPECT_EQ(read.surfaces[0].scalars[1].values.back(),
              scene.surfaces[1].scalars[1].values.back());
  }
}

TEST(SurfaceFile, TheSameSceneGivesTheSameBytes) {
  for (const SurfaceFormat& format : test::written_formats()) {
    SCOPED_TRACE(format.extension);
    const TemporaryFolder first, second;
    write_surfaces(first.path() / ("f" + std::string(format.extension)), test::two_letters());
    write_surfaces(second.path() / ("f" + std::string(format.extension)), test::two_letters());
    ASSERT_EQ(test::files_in(first.path()), test::files_in(second.path()));
    for (const auto& entry : std::filesystem::directory_iterator(first.path())) {
      EXPECT_EQ(test::content_of(entry.path()),
                test::content_of(second.path() / entry.path().filename()));
    }
  }
}

TEST(SurfaceFile, StlSaysInItsHeaderWhatFits) {
  const TemporaryFolder folder;
  SurfaceScene scene;
  scene.surfaces = {test::letter_surface("F", 0)};
  scene.metadata = {{"a.long", std::string(70, 'x')}, {"b.source", "scan 1"}, {"c.date", "none"}};
  write_surfaces(folder.path() / "f.stl", scene, {3.7e5, 5});
  const std::string header = test::content_of(folder.path() / "f.stl").substr(0, 80);
  EXPECT_THAT(header, testing::StartsWith(
                          "semsurf mm magnification=370000 z=5 b.source=scan%201 c.date=none "));
  EXPECT_THAT(header, Not(HasSubstr("xxx")));
  EXPECT_EQ(read_surfaces(folder.path() / "f.stl").metadata,
            (std::map<std::string, std::string>{{"b.source", "scan 1"}, {"c.date", "none"}}));
  write_surfaces(folder.path() / "g.stl", scene, {1.2345678901234567e-11, 1.2345678901234567e-11});
  EXPECT_EQ(test::content_of(folder.path() / "g.stl").size(),
            test::content_of(folder.path() / "f.stl").size());
}

TEST(SurfaceFile, ObjPutsEachVertexOnThePixelAboveIt) {
  const TemporaryFolder folder;
  Drape drape{{10, 5, 100, 50}, "SE", Grid<std::uint8_t>(4, 2)};
  SurfaceScene scene;
  scene.surfaces = {{"t",
                     {{{100, 50, 0}, {130, 50, 0}, {115, 55, 7}, {0, 0, 0}, {999, 999, 0}},
                      {{0, 1, 2}, {3, 4, 2}}},
                     {},
                     drape}};
  write_surfaces(folder.path() / "a.obj", scene);
  const std::string text = test::content_of(folder.path() / "a.obj");
  EXPECT_THAT(
      text, HasSubstr("vt 0.125 0.25\nvt 0.875 0.25\nvt 0.5 0.75\nvt 0.125 0.25\nvt 0.875 0.75\n"));
  EXPECT_THAT(text, HasSubstr("mtllib a.mtl\n"));
  EXPECT_THAT(text, HasSubstr("usemtl drape1\nf 1/1 2/2 3/3\n"));
  EXPECT_THAT(test::content_of(folder.path() / "a.mtl"), HasSubstr("newmtl drape1\n"));
  EXPECT_THAT(test::content_of(folder.path() / "a.mtl"), HasSubstr("map_Kd a_drape1.png\n"));
  EXPECT_EQ(test::files_in(folder.path()), 3);
}

TEST(SurfaceFile, ScalarsOfOthersGetNamesAndUnits) {
  const TemporaryFolder folder;
  test::write(folder.path() / "a.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
              "y\nproperty float z\n"
              "property float nx\nproperty double Quality\nproperty uchar 2nd\nproperty float bad\n"
              "property list uchar int ring\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n"
              "0 0 0 0 0.5 7 1 0\n1 0 0 0 1.5 8 1e300 1 5\n0 1 0 0 2.5 9 1 0\n3 0 1 2\n");
  const SurfaceScene scene = read_surfaces(folder.path() / "a.ply");
  const auto& scalars = scene.surfaces.at(0).scalars;
  ASSERT_EQ(scalars.size(), 2u) << "normals and lists are none, and one is not finite";
  EXPECT_EQ(scalars[0].name, "quality");
  EXPECT_EQ(scalars[0].unit, "1");
  EXPECT_EQ(scalars[0].values, (std::vector<float>{0.5F, 1.5F, 2.5F}));
  EXPECT_EQ(scalars[1].name, "scalar_2nd");
  validate(scene);
}

}  // namespace
}  // namespace surf::io
