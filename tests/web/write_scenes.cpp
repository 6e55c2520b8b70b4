// SPDX-License-Identifier: GPL-3.0-or-later
// Writes every kind of glTF file for the checkers, and beside each the box that it should have in a
// viewer. Usage: web_scenes FOLDER
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <fstream>

#include "mesh/some_surfaces.h"
#include "mesh/through_format.h"

namespace {

using namespace surf;

/// In metres, y up.
std::string expected_box(const SurfaceScene& scene, const io::Magnification& magnification) {
  Box box;
  for (const Surface& surface : scene.surfaces) box.extend(bounds(surface.mesh));
  for (const Track& track : scene.tracks) {
    for (const Vec3& p : track.points_nm) box.extend(p);
  }
  const double s = magnification.factor * 1e-9, z = s * magnification.z_exaggeration;
  const Vec3 &low = box.lower_nm, &high = box.upper_nm;
  return fmt::format("[[{}, {}, {}], [{}, {}, {}]]\n", s * low.x, z * low.z, -s * high.y,
                     s * high.x, z * high.z, -s * low.y);
}

void write(const std::filesystem::path& path, const SurfaceScene& scene,
           const io::Magnification& magnification = {}) {
  validate(scene);
  for (const io::OutputFile& file : test::formatted(io::gltf_format, path, scene, magnification)) {
    std::ofstream(file.path, std::ios::binary) << file.content;
  }
  std::ofstream(path.string() + ".box.json") << expected_box(scene, magnification);
}

void write_all(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const SurfaceScene full = test::full_scene();
  write(folder / "full.glb", full);
  write(folder / "true size.gltf", full, {1, 1});
  write(folder / "high.glb", full, {1e6, 8});
  write(folder / "letter.glb", test::scene_of({"F", test::letter_f_triangles(), {}, {}}));
  Surface draped = test::wavy_sheet("draped", 40, {-20, -20, 0});
  draped.drape = test::letter_f_drape();
  draped.drape->pitch_x_nm = 8;
  draped.drape->pitch_y_nm = 40.0 / 7;
  draped.drape->origin_x_nm = -16;
  draped.drape->origin_y_nm = -20 + 20.0 / 7;
  write(folder / "draped.gltf", test::scene_of(draped));
  write(folder / "large.glb",
        test::scene_of(test::wavy_sheet("70,225 vertices", 264, {1e7, 0, 0})));
  write(folder / "one.glb",
        test::scene_of({"one", {{{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}}, {{0, 1, 2}}}, {}, {}}));
  write(folder / "thin.glb", test::scene_of({"thin",
                                             {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}},
                                              {{0, 1, 2}, {0, 1, 3}, {1, 1, 1}}},
                                             {},
                                             {}}));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    write_all(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
