// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "letter_f_mesh.h"
#include "surf/mesh/surface.h"
#include "vtk/some_tracks.h"

namespace surf::test {

/// A sheet of (n + 1)^2 vertices over a square of that many nm, with every scalar that a surface
/// may have.
inline Surface wavy_sheet(const std::string& name, int n, const Vec3& corner_nm) {
  Surface surface{
      name, {}, {{"height", "nm", {}}, {"curvature", "1/nm", {}}, {"certainty", "1", {}}}, {}};
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const double z = 0.1 * n * std::sin(6.0 * x / n) * std::cos(4.0 * y / n);
      surface.mesh.vertices_nm.push_back(corner_nm + Vec3{double(x), double(y), z});
      surface.scalars[0].values.push_back(static_cast<float>(z));
      surface.scalars[1].values.push_back(static_cast<float>(-z / (n * n) + 1e-30));
      surface.scalars[2].values.push_back(static_cast<float>(x) / 3.0F);
    }
  }
  const auto vertex = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      surface.mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
      surface.mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    }
  }
  return surface;
}

/// An F in grey, which no flip leaves as it is.
inline Drape letter_f_drape() {
  Drape drape{{0.8, 0.6, 0.25, -1e-3}, "SE \xC3\xA9", Grid<std::uint8_t>(5, 7, 40)};
  const char* const rows[7] = {".....", ".###.", ".#...", ".##..", ".#...", ".#...", "o...."};
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 5; ++x) {
      if (rows[6 - y][x] == '#') drape.grey(x, y) = 255;
      if (rows[6 - y][x] == 'o') drape.grey(x, y) = 128;
    }
  }
  return drape;
}

/// All that a file can hold: bodies, sheets, a drape, tracks and provenance.
inline SurfaceScene full_scene() {
  SurfaceScene scene;
  scene.surfaces.push_back({"F <1> & \"\xC3\xA9\"", letter_f_triangles(), {}, letter_f_drape()});
  scene.surfaces.push_back(wavy_sheet("waves", 20, {10, -3.7, 1.0 / 3}));
  scene.tracks = two_tracks();
  for (Track& track : random_walks(10)) scene.tracks.push_back(std::move(track));
  scene.metadata = {
      {"semsurf.version", "1.2"}, {"beam.energy_ev", "1000"}, {"note", "a \"b\" <c> &\n\xC3\xA9"}};
  return scene;
}

inline SurfaceScene scene_of(Surface surface) {
  SurfaceScene scene;
  scene.surfaces.push_back(std::move(surface));
  return scene;
}

/// The farthest that a vertex has moved, beside the extent of its surface.
inline double relative_shift(const Surface& before, const Surface& after) {
  const Vec3 size = bounds(before.mesh).size_nm();
  double farthest = 0;
  for (std::size_t i = 0; i < before.mesh.vertices_nm.size(); ++i) {
    farthest =
        std::max(farthest, length(before.mesh.vertices_nm[i] - after.mesh.vertices_nm.at(i)));
  }
  return farthest / std::max({size.x, size.y, size.z});
}

}  // namespace surf::test
