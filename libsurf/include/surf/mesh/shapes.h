// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

// Test specimens. Lengths in nm, > 0 unless said otherwise; bodies are closed with outward normals.

/// A box between two corners. `subdivisions` splits every edge into that many pieces (>= 1).
TriangleMesh make_box(const Vec3& lower_nm, const Vec3& upper_nm, int subdivisions = 1);

/// A sphere of flat triangles with corners on the sphere: an icosahedron split `subdivisions`
/// times (0 to 9), 20 * 4^subdivisions triangles.
TriangleMesh make_sphere(const Vec3& center_nm, double radius_nm, int subdivisions = 4);

/// A truncated cone about a vertical axis through `base_nm`: `bottom_radius_nm` at z = base,
/// `top_radius_nm` (>= 0; 0 is a tip) `height_nm` above it. It has `segments` (3 to 100,000) flat
/// sides whose edges lie on the cone.
TriangleMesh make_cone(const Vec3& base_nm, double bottom_radius_nm, double top_radius_nm,
                       double height_nm, int segments = 64);

/// Size and sampling of a height field centred on (0, 0).
struct FieldExtent {
  double width_nm = 400;  ///< along x, from the centre of the first sample to that of the last
  double depth_nm = 400;  ///< along y, likewise
  double pitch_nm = 2;    ///< sample distance; width and depth are rounded to whole pitches
};

/// A square mesa with a flat top on a plane at z = 0: `top_width_nm` wide at the top. The walls run
/// outwards by `wall_run_nm` (>= 0; 0 means one pitch) while they fall by `height_nm`.
HeightField make_mesa(const FieldExtent& extent, double height_nm, double top_width_nm,
                      double wall_run_nm);

/// A trench along y in a plane at z = 0: `bottom_width_nm` wide at the bottom and `depth_nm` deep.
/// Each wall runs outwards by `wall_run_nm` (>= 0; 0 means one pitch).
HeightField make_trench(const FieldExtent& extent, double depth_nm, double bottom_width_nm,
                        double wall_run_nm);

/// A line along y on a plane at z = 0: `top_width_nm` wide at the top and `height_nm` high. Each
/// wall runs outwards by `wall_run_nm` (>= 0; 0 means one pitch).
HeightField make_line(const FieldExtent& extent, double height_nm, double top_width_nm,
                      double wall_run_nm);

/// A round hole in a plane at z = 0: `bottom_width_nm` across at the bottom and `depth_nm` deep.
/// Its wall runs outwards by `wall_run_nm` (>= 0; 0 means one pitch).
HeightField make_via(const FieldExtent& extent, double depth_nm, double bottom_width_nm,
                     double wall_run_nm);

/// A step along y: height 0 left of the middle and `height_nm` right of it. The wall is centred on
/// the middle and `wall_run_nm` (>= 0; 0 means one pitch) long.
HeightField make_step(const FieldExtent& extent, double height_nm, double wall_run_nm);

/// Lines along y like those of make_line, `period_nm` apart, one of them in the middle. The period
/// must exceed the width at the foot.
HeightField make_grating(const FieldExtent& extent, double height_nm, double period_nm,
                         double top_width_nm, double wall_run_nm);

/// A Gaussian rough surface of zero mean with root-mean-square height `rms_nm` and the Gaussian
/// autocorrelation exp(-r^2 / L^2), L = `correlation_nm`. It is periodic over the extent plus one
/// pitch, so that `periodic` edges are seamless. The same `seed` gives the same surface.
HeightField make_rough(const FieldExtent& extent, double rms_nm, double correlation_nm,
                       std::uint64_t seed);

/// A self-affine rough surface of zero mean. Its power spectral density is proportional to (1 + (2
/// pi f L)^2)^-(1 + H) at the spatial frequency f, with L = `correlation_nm` and the Hurst exponent
/// H = `hurst` in (0, 1] (Palasantzas 1993, doi:10.1103/PhysRevB.48.14472). It is scaled to the
/// root-mean-square height `rms_nm`. Period, seed and limits are those of make_rough.
HeightField make_self_affine(const FieldExtent& extent, double rms_nm, double correlation_nm,
                             double hurst, std::uint64_t seed);

/// A value of a two-dimensional, isotropic power spectral density. The integral of the density over
/// the plane of frequencies is the mean square height.
struct SpectralDensity {
  double frequency_per_nm;  ///< cycles per nm, > 0
  double density_nm4;       ///< >= 0
};

/// A Gaussian rough surface of zero mean with a tabulated spectrum: at least two points with rising
/// frequencies, interpolated linearly, 0 outside. Its mean square height scatters about that of the
/// spectrum, as for a piece cut from an endless surface. Period and seed are those of make_rough.
HeightField make_rough_from_spectrum(const FieldExtent& extent,
                                     const std::vector<SpectralDensity>& spectrum,
                                     std::uint64_t seed);

}  // namespace surf
