// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/affine.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// What is measured in an image. Lines and trenches run along y; a line is material on the ground,
/// a trench a gap in it; an edge has ground at its left; a hole is a round trench.
enum class FeatureKind { line, trench, edge, hole };

/// A wall's cross-section: a straight flank between rounded corners, on level ground, under a level
/// top.
struct WallShape {
  double height_nm = 100;     ///< > 0
  double angle_deg = 88;      ///< between ground and flank, within the material; above 90: undercut
  double top_radius_nm = 3;   ///< >= 0
  double foot_radius_nm = 3;  ///< >= 0

  friend bool operator==(const WallShape&, const WallShape&) = default;
};

/// A feature with two walls alike; an edge has one.
struct FeatureShape {
  FeatureKind kind = FeatureKind::line;
  double width_nm = 100;  ///< at half the height: of the material of a line, of the gap otherwise
  double pitch_nm = 0;  ///< distance of lines or trenches; 0: there is one. None of edges and holes
  WallShape wall;
};

/// The wall from its foot to its top: points (u, z), with u = 0 on the flank at half the height and
/// the material at positive u. Corners are arcs in steps of at most 10 degrees. Throws InvalidInput
/// where the corners need more flank than there is, or a number is out of range.
std::vector<Point2> wall_profile(const WallShape& wall);

/// How far beyond its middle the wall's corners reach: to the ground at negative u, to the top.
struct WallExtent {
  double ground_nm, top_nm;  ///< both >= 0
};
WallExtent wall_extent(const WallShape& wall);

/// The feature's surface as an open sheet, which goes on level beyond its rim: normals up, ground
/// of a line at z = 0 and its top at the height; a trench's bottom at 0. The first feature's middle
/// (an edge's wall) is at x = 0; others follow at the pitch within `reach_nm` on both sides. Lines,
/// trenches and edges extend by `reach_nm` along y. Throws InvalidInput for shapes whose walls
/// meet.
TriangleMesh feature_mesh(const FeatureShape& shape, double reach_nm);

/// "line", "trench", "edge", "hole".
const char* name(FeatureKind kind);
/// Throws UsageError naming `subject`.
FeatureKind parse_feature_kind(const std::string& text, const std::string& subject);

}  // namespace surf
