// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/height_field.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

// Test specimens. Lengths in nm, > 0 unless said otherwise; bodies are closed with outward normals.

/// A box between two corners. `subdivisions` splits every edge into that many pieces (>= 1).
TriangleMesh make_box(const Vec3& lower_nm, const Vec3& upper_nm, int subdivisions = 1);

/// A sphere of flat triangles with corners on the sphere: an icosahedron split `subdivisions`
/// times (0 to 9), 20 * 4^subdivisions triangles.
TriangleMesh make_sphere(const Vec3& center_nm, double radius_nm, int subdivisions = 4);

/// Size and sampling of a height field centred on (0, 0).
struct FieldExtent {
  double width_nm = 400;    ///< from the centre of the first sample to that of the last, along x
  double depth_nm = 400;    ///< the same along y
  double pitch_nm = 2;      ///< sample distance; width and depth are rounded to whole pitches
};

/// A square, flat-topped mesa on a plane at z = 0: `top_width_nm` wide at the top, walls sloping
/// outwards by `wall_run_nm` (>= 0; 0 means one pitch) while falling `height_nm`.
HeightField make_mesa(const FieldExtent& extent, double height_nm, double top_width_nm,
                      double wall_run_nm);

/// A trench along y in a plane at z = 0, `bottom_width_nm` wide at the bottom, `depth_nm` deep,
/// each wall running outwards by `wall_run_nm` (>= 0; 0 means one pitch).
HeightField make_trench(const FieldExtent& extent, double depth_nm, double bottom_width_nm,
                        double wall_run_nm);

/// A Gaussian rough surface of zero mean: root-mean-square height `rms_nm`, Gaussian
/// autocorrelation exp(-r^2 / L^2) with L = `correlation_nm`; periodic over the extent plus one
/// pitch, so that `periodic` edges are seamless. The same `seed` gives the same surface.
HeightField make_rough(const FieldExtent& extent, double rms_nm, double correlation_nm,
                       std::uint64_t seed);

}  // namespace surf
