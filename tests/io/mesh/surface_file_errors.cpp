// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fstream>
#include <limits>

#include "io_test.h"
#include "surf/io/mesh_file.h"
#include "surf/io/surface_file.h"
#include "surface_scenes.h"

namespace surf::io {
namespace {

using test::complaint;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(SurfaceFileErrors, TargetsAreCheckedEarly) {
  const TemporaryFolder folder;
  const auto& root = folder.path();
  for (const char* name : {"a.jpg", "a", "a.step"}) {
    EXPECT_THAT(complaint<UsageError>([&] { check_surface_target(root / name); }),
                HasSubstr(".3mf, .obj"));
    EXPECT_THAT(complaint<UsageError>([&] { write_surfaces(root / name, test::two_letters()); }),
                HasSubstr("not written"));
  }
  std::filesystem::create_directory(root / "b.ply");
  EXPECT_THAT(complaint<FileError>([&] { check_surface_target(root / "b.ply"); }),
              HasSubstr("folder"));
  EXPECT_EQ(check_surface_target(root / "C.Ply").extension, ".ply");
  EXPECT_EQ(test::files_in(root), 1);
}

TEST(SurfaceFileErrors, NothingIsHalfWritten) {
  for (const SurfaceFormat& format : test::written_formats()) {
    SCOPED_TRACE(format.extension);
    const TemporaryFolder folder;
    const auto path = folder.path() / ("f" + std::string(format.extension));
    const double nan = std::nan("");
    SurfaceScene bad = test::two_letters();
    bad.surfaces[1].mesh.vertices_nm[3].z = nan;
    EXPECT_THAT(complaint<InvalidInput>([&] { write_surfaces(path, bad); }), HasSubstr("vertex 3"));
    bad = test::two_letters();
    bad.surfaces[0].scalars[1].values[2] = std::numeric_limits<float>::infinity();
    EXPECT_THAT(complaint<InvalidInput>([&] { write_surfaces(path, bad); }), HasSubstr("'height'"));
    bad = test::two_letters();
    bad.surfaces[0].name = bad.surfaces[1].name;
    EXPECT_THAT(complaint<InvalidInput>([&] { write_surfaces(path, bad); }), HasSubstr("unique"));
    EXPECT_THAT(complaint<InvalidInput>([&] { write_surfaces(path, {}); }),
                HasSubstr("no surface"));
    for (const double factor : {0.0, -1.0, nan, std::numeric_limits<double>::infinity(), 1e-310}) {
      EXPECT_THAT(complaint<UsageError>([&] {
                    write_surfaces(path, test::two_letters(), {factor, 1});
                  }),
                  HasSubstr("cannot be a"));
      EXPECT_EQ(test::files_in(folder.path()), 0);
    }
    EXPECT_THAT(complaint<UsageError>([&] {
                  write_surfaces(path, test::two_letters(), {1, -2});
                }),
                HasSubstr("exaggeration"));
    EXPECT_EQ(test::files_in(folder.path()), 0);
  }
}

TEST(SurfaceFileErrors, AFileBesideThatCannotBeWrittenLeavesNothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "f_drape2.png" / "in the way");
  EXPECT_THAT(
      complaint<FileError>([&] { write_surfaces(folder.path() / "f.obj", test::two_letters()); }),
      HasSubstr("f_drape2.png"));
  EXPECT_EQ(test::files_in(folder.path()), 1);
  if (!test::has_vtk()) return;
  std::filesystem::create_directories(folder.path() / "f_tracks.vtp" / "in the way");
  EXPECT_THAT(
      complaint<FileError>([&] { write_surfaces(folder.path() / "f.vtm", test::two_letters()); }),
      HasSubstr("f_tracks.vtp"));
  EXPECT_EQ(test::files_in(folder.path()), 2);
}

TEST(SurfaceFileErrors, NumbersThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  const SurfaceScene scene = test::two_letters();
  const auto write_as = [&](const char* name, const Magnification& m) {
    return complaint<InvalidInput>([&] { write_surfaces(folder.path() / name, scene, m); });
  };
  EXPECT_THAT(write_as("a.stl", {1e45, 1}), HasSubstr("too large"));
  EXPECT_THAT(write_as("a.stl", {1e-40, 1}), HasSubstr("too small"));
  EXPECT_THAT(write_as("a.stl", {1e6, 1e-40}), HasSubstr("too small"));
  EXPECT_THAT(write_as("a.obj", {1e308, 1e10}), HasSubstr("too large"));
  EXPECT_THAT(write_as("a.obj", {1e-299, 1}), HasSubstr("too small"));
  EXPECT_EQ(test::files_in(folder.path()), 0);
}

TEST(SurfaceFileErrors, PlyRefusesNamesThatMeanSomethingElse) {
  const TemporaryFolder folder;
  SurfaceScene scene = test::two_letters();
  for (Surface& surface : scene.surfaces) surface.scalars[1].name = "red";
  EXPECT_THAT(complaint<InvalidInput>([&] { write_surfaces(folder.path() / "a.ply", scene); }),
              HasSubstr("'red'"));
  EXPECT_EQ(test::files_in(folder.path()), 0);
}

TEST(SurfaceFileErrors, DamagedNotesAreNotBelieved) {
  const TemporaryFolder folder;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* note : {"magnification=0", "magnification=1e-320", "magnification=1 nm",
                           "unit_nm=nan", "z_exaggeration=-1", "magnification="}) {
    const auto path =
        test::write(folder.path() / "a.obj", fmt::format("# surface:{}\n{}", note, triangle));
    EXPECT_THAT(complaint<FileError>([&] { read_mesh(path); }), HasSubstr("surface:"));
  }
  const auto path = test::write(folder.path() / "b.obj",
                                "# surface:name.999999999999=x\n# surface:magnification=1\n"
                                "# surface:name.0=y\n" +
                                    triangle);
  EXPECT_EQ(read_surfaces(path).surfaces.at(0).name, "b");
  EXPECT_EQ(read_mesh(path).vertices_nm[1].x, 1e6);
}

TEST(SurfaceFileErrors, PicturesAreLookedForBesideTheFileOnly) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "f.obj";
  write_surfaces(path, test::two_letters());
  std::filesystem::remove(folder.path() / "f_drape2.png");
  EXPECT_THAT(complaint<FileError>([&] { read_surfaces(path); }),
              HasSubstr("f_drape2.png is missing"));
  EXPECT_EQ(read_meshes(path).size(), 2u) << "shapes do not need it";
  std::string text = test::content_of(path);
  text.replace(text.find("f_drape2.png"), 12, "../x/../a.png");
  test::write(path, text);
  EXPECT_THAT(complaint<FileError>([&] { read_surfaces(path); }), HasSubstr("not beside"));
}

}  // namespace
}  // namespace surf::io
