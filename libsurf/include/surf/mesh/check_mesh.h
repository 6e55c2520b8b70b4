// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// The result of `check_mesh`. Edges are undirected vertex pairs.
struct MeshReport {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t degenerate_triangles = 0;  ///< zero area, or a corner used twice
  std::size_t duplicate_triangles = 0;   ///< triangles beyond the first on the same three corners
  std::size_t boundary_edges = 0;        ///< edges of exactly one triangle
  std::size_t nonmanifold_edges = 0;     ///< edges of more than two triangles
  /// Edges that both of their triangles traverse in the same direction.
  std::size_t inconsistent_edges = 0;
  std::size_t doubled_directed_edges = 0;  ///< directed edges that several triangles traverse
  std::size_t nonmanifold_vertices = 0;    ///< points whose triangles form several fans
  std::size_t components = 0;              ///< sets of triangles connected through shared vertices
  double area_nm2 = 0;
  double signed_volume_nm3 = 0;  ///< > 0 when normals point out; meaningful when closed
  Box bounds_nm;
  Vec3 first_boundary_nm;            ///< midpoint of one boundary edge, if there is any
  Vec3 first_nonmanifold_nm;         ///< midpoint of one non-manifold edge, if there is any
  Vec3 first_inconsistent_nm;        ///< midpoint of one inconsistent edge, if there is any
  Vec3 first_nonmanifold_vertex_nm;  ///< one non-manifold vertex, if there is any
  Vec3 first_degenerate_nm;          ///< centre of one degenerate triangle, if there is any
  Vec3 first_duplicate_nm;           ///< centre of one duplicate triangle, if there is any

  /// Every edge is traversed equally often in both directions, so that inside and outside are
  /// defined everywhere. Non-manifold edges are allowed if they balance.
  bool closed_and_oriented = false;
};

/// Examines the mesh in O(n log n). Corners at exactly equal coordinates count as one vertex.
/// Throws Interrupted.
MeshReport check_mesh(const TriangleMesh& mesh, const Watch& watch = {});

/// The component (see MeshReport::components) of every triangle: numbers from 0, in the order of
/// first appearance.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh);

/// The faults of a mesh, one line each with number and place: "open: 3 boundary edges near (1, 2,
/// 3) nm". Empty for a mesh without faults. Doubled directed edges are not listed, because they
/// coincide with inconsistent or non-manifold edges.
std::vector<std::string> faults(const MeshReport& report);

/// Summarises the report in one line: "closed, 12 triangles, 8 vertices, 1 component", or the
/// faults with their places.
std::string summary(const MeshReport& report);

}  // namespace surf
