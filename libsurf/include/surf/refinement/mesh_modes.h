// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// A way in which a mesh may change: vertices move by a vector per nm of amplitude.
struct MeshMode {
  struct Move {
    std::uint32_t vertex;
    Vec3 by;  ///< nm per nm; at most about 1 long
  };
  std::vector<Move> moves;
  /// Of a bump: its middle, the surface's normal there, and how far from it vertices move.
  Vec3 middle_nm, normal;
  double reach_nm = 0;    ///< 0: the mode is no bump, it moves the whole mesh
  bool vertical = false;  ///< of the whole mesh, along z

  bool is_bump() const { return reach_nm > 0; }
};

/// Displacements that are polynomials of the place, up to the second degree in each direction of
/// space: scales, turns, shears, tapers (the angles of walls), bends; no shifts, which no image
/// tells. Of heights the lower end of the box stays. Beside the box a place counts as the nearest
/// one of the box, so that what is beyond it moves alike; the rim of an open mesh stays. None moves
/// a vertex by more than 1 nm per nm.
enum class SmoothKind {
  walls,  ///< sizes along x, y and z; walls that lean or taper along x and y: 7 modes
  all,    ///< 27 modes
};
std::vector<MeshMode> smooth_modes(const TriangleMesh& mesh, const Box& box,
                                   SmoothKind kind = SmoothKind::all);

/// Bumps along the surface's normals, `spacing_nm` (> 0) apart on it, which add up to 1 wherever
/// `may_move` (one per vertex) is not 0; other vertices stay. A bump reaches along the surface, and
/// not through a thin wall to its other side.
std::vector<MeshMode> bump_modes(const TriangleMesh& mesh, const std::vector<bool>& may_move,
                                 double spacing_nm);

/// Modes in groups whose bumps do not touch each other: further apart than both reaches and
/// `margin_nm`. Of smooth modes each is a group of its own. Each group is in rising order.
std::vector<std::vector<std::size_t>> groups_apart(const std::vector<MeshMode>& modes,
                                                   double margin_nm);

/// The mesh with its modes moved by amplitudes in nm, one per mode.
TriangleMesh moved(const TriangleMesh& mesh, const std::vector<MeshMode>& modes,
                   std::span<const double> amplitudes_nm);

/// What is known of amplitudes beforehand: a normal distribution of mean 0 with this covariance
/// (row-major). Smooth modes are independent, with the deviation `smooth_nm`, or `height_nm` where
/// they move along z; bumps are those of a
/// surface that is off by `bump_nm`, with a correlation that falls off as a Gaussian of the
/// distance over `length_nm` and of the normals' difference. All > 0.
struct ModePrior {
  double smooth_nm = 10, height_nm = 10, bump_nm = 4, length_nm = 20;
};
std::vector<double> prior_covariance(const std::vector<MeshMode>& modes, const ModePrior& prior);

}  // namespace surf
