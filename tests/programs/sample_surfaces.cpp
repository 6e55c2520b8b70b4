// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: sample_surfaces FOLDER. Writes a closed letter F of 300 x 250 x 25 nm in every format, as
// letter.EXT, with a picture, scalars and electron tracks where the format holds them; the letter
// and a copy beside it as pair.EXT where it holds several; and expected.json.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "mesh/surface_scenes.h"
#include "surf/io/files.h"
#include "surf/mesh/measure_mesh.h"

namespace surf {
namespace {

Surface letter(const char* name, double shift_nm) {
  Surface surface;
  surface.name = name;
  surface.mesh = test::letter_f_triangles();
  transform(surface.mesh, 100, {shift_nm, 0, 0});
  surface.scalars = {{"height", "nm", {}}, {"certainty", "1", {}}};
  for (const Vec3& v : surface.mesh.vertices_nm) {
    surface.scalars[0].values.push_back(static_cast<float>(v.z));
    surface.scalars[1].values.push_back(static_cast<float>(v.y / 250));
  }
  surface.drape = Drape{{10, 10, shift_nm + 5, 5}, "SE", Grid<std::uint8_t>(30, 25, 90)};
  for (int x = 0; x < 30; ++x) surface.drape->grey(x, 20) = 255;
  return surface;
}

void write_samples(const std::filesystem::path& folder) {
  SurfaceScene one, two;
  one.surfaces.push_back(letter("letter", 0));
  one.tracks = test::two_tracks();
  one.metadata = {{"semsurf.version", "test"}, {"source", "letter F"}};
  two.surfaces = {letter("left", 0), letter("right", 500)};
  for (const io::SurfaceFormat& format : test::written_formats()) {
    io::write_surfaces(folder / ("letter" + std::string(format.extension)), one);
    if (format.several) io::write_surfaces(folder / ("pair" + std::string(format.extension)), two);
  }
  const TriangleMesh& mesh = one.surfaces[0].mesh;
  const Box box = bounds(mesh);
  io::write_text(folder / "expected.json",
                 fmt::format("{{\"vertices\": {}, \"triangles\": {}, \"low\": [{}, {}, {}], "
                             "\"high\": [{}, {}, {}], \"volume\": {}}}\n",
                             mesh.vertices_nm.size(), mesh.triangles.size(), box.lower_nm.x,
                             box.lower_nm.y, box.lower_nm.z, box.upper_nm.x, box.upper_nm.y,
                             box.upper_nm.z, 8 * 100 * 50 * 25));
}

}  // namespace
}  // namespace surf

int main(int count, char** arguments) {
  try {
    if (count != 2) return 2;
    surf::write_samples(arguments[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
