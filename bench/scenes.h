// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Specimens and scans that several benchmarks measure.

#include <cmath>

#include "surf/io/sim/materials.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mesh/shapes.h"

namespace surf::bench {

/// No shape yet; material 0 is silicon, 1 gold.
inline mc::Specimen silicon() {
  mc::Specimen s;
  s.materials = {io::find_material("Si", "bench"), io::find_material("Au", "bench")};
  return s;
}

/// Silicon alone: replay makes cascades of every material.
inline mc::Specimen only_silicon() {
  mc::Specimen s = silicon();
  s.materials.pop_back();
  return s;
}

inline mc::Specimen flat(mc::Specimen s) {
  s.substrate = mc::Substrate{};
  return s;
}

/// Seeger's figure 5-6: 200 nm high, 80 nm wide at the top; at a pitch of 2 nm 79,202 triangles
/// over 398 nm.
inline mc::Specimen mesa(mc::Specimen s, double pitch_nm = 2) {
  s.height_field =
      mc::HeightFieldBody{"mesa", make_mesa({398, 398, pitch_nm}, 200, 80, 2), 0, Edge::flat};
  return s;
}

/// Gentle crossed waves a (sin k x + sin 0.9 k y) over 600 nm, as long as `wavelength_nm`, whose
/// smallest radius of curvature 1 / (a k^2) is `radius_nm`: slopes to about 1 / (k radius).
inline mc::Specimen waves(mc::Specimen s, double wavelength_nm, double radius_nm, double pitch_nm) {
  const double k = 2 * 3.14159265358979324 / wavelength_nm;
  const double height_nm = 1 / (k * k * radius_nm);
  const int n = static_cast<int>(600 / pitch_nm) + 1;
  HeightField f;
  f.z_nm = Grid<double>(n, n);
  f.pitch_x_nm = f.pitch_y_nm = pitch_nm;
  f.origin_x_nm = f.origin_y_nm = -0.5 * (n - 1) * pitch_nm;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      f.z_nm(x, y) = height_nm * (std::sin(k * f.x_nm(x)) + std::sin(0.9 * k * f.y_nm(y)));
  s.height_field = mc::HeightFieldBody{"waves", f, 0, Edge::mirror};
  return s;
}

/// Square, about the origin.
inline mc::Scan view(double width_nm, int pixels) {
  mc::Scan scan;
  scan.width = scan.height = pixels;
  scan.pixel_x_nm = scan.pixel_y_nm = width_nm / pixels;
  return scan;
}

inline mc::Beam beam(double energy_ev) {
  mc::Beam b;
  b.energy_ev = energy_ev;
  return b;
}

}  // namespace surf::bench
