// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "letter_f_mesh.h"
#include "surf/io/image_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/surface.h"
#include "vtk/some_tracks.h"

namespace surf::test {

/// 3 x 4 pixels, no two equal, placed unevenly over the letter.
inline Drape picture() {
  Drape drape{{1.25, 0.7, 1.0 / 3, 0.25}, "SE in-lens", Grid<std::uint8_t>(3, 4)};
  for (std::size_t i = 0; i < drape.grey.size(); ++i)
    drape.grey.data()[i] = static_cast<std::uint8_t>(3 + 21 * i);
  return drape;
}

/// The letter F at a place of thirds, with two scalars.
inline Surface letter_surface(const std::string& name, double shift_nm) {
  Surface surface;
  surface.name = name;
  surface.mesh = letter_f_triangles();
  surface.scalars = {{"certainty", "1", {}}, {"height", "nm", {}}, {"curvature_2", "1/nm", {}}};
  for (Vec3& v : surface.mesh.vertices_nm) {
    v = {v.x / 3 + shift_nm, v.y / 7, v.z / 11 + 100.1};
    surface.scalars[0].values.push_back(static_cast<float>(v.y));
    surface.scalars[1].values.push_back(static_cast<float>(v.z));
    surface.scalars[2].values.push_back(static_cast<float>(-1e-7 * v.x));
  }
  return surface;
}

/// Two surfaces, the second with a picture; awkward names and texts.
inline SurfaceScene two_letters() {
  SurfaceScene scene;
  scene.surfaces = {letter_surface("substrate #1, 50 % <\xC3\xA9>", 0),
                    letter_surface("F  on\\ top", 20)};
  scene.surfaces[1].drape = picture();
  scene.tracks = two_tracks();
  scene.metadata = {{"semsurf.version", "1.2"},
                    {"beam.energy_ev", "1000"},
                    {"empty", ""},
                    {"title", "a=b \\ \"c\" <d> & \xC3\xA9 50%41\nsecond line\\"}};
  return scene;
}

inline bool has_vtk() { return io::image_library_versions().find("VTK") != std::string::npos; }

/// The formats that this build writes.
inline std::vector<io::SurfaceFormat> written_formats() {
  std::vector<io::SurfaceFormat> formats;
  for (const io::SurfaceFormat& format : io::surface_formats()) {
    if (has_vtk() || !format.extension.starts_with(".vt")) formats.push_back(format);
  }
  return formats;
}

/// Float32 in the file: nm may be off by half a unit in the last place of the largest coordinate.
inline bool is_float32(const io::SurfaceFormat& format) {
  return format.extension == ".stl" || format.extension == ".3mf" || format.extension == ".glb" ||
         format.extension == ".gltf";
}

}  // namespace surf::test
