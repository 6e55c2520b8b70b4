// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf {

/// Sizes of a mesh.
struct MeshMeasures {
  Box bounds_nm;
  double area_nm2 = 0;
  double volume_nm3 = 0;  ///< > 0 when normals point out; meaningful when closed
  Vec3 centroid_nm;       ///< of the surface
  double shortest_edge_nm = 0;
  double mean_edge_nm = 0;
  double longest_edge_nm = 0;
  /// Of the Gaussian curvature over the inner points; 4 pi for each ball-like body.
  double gaussian_integral = 0;
  double mean_integral_nm = 0;  ///< of the mean curvature over the surface
};

/// Curvature at a vertex; 0 at rims, non-manifold edges and unused vertices.
struct Curvature {
  double mean_per_nm = 0;       ///< mean of the principal curvatures; > 0 on a ball, normals out
  double gaussian_per_nm2 = 0;  ///< product of the principal curvatures
  double area_nm2 = 0;          ///< area of the surface nearest to the vertex
};

/// Measures a mesh. Triangles without area do not count. Throws InvalidInput on damaged meshes.
MeshMeasures measure_mesh(const TriangleMesh& mesh);

/// The curvature at each vertex, from the angles and cotangents of its triangles (Meyer et al.
/// 2003, doi:10.1007/978-3-662-05105-4_2). On smooth surfaces the error is proportional to the edge
/// length, or to its square if the triangles are regular. Throws InvalidInput on damaged meshes.
std::vector<Curvature> mesh_curvature(const TriangleMesh& mesh);

}  // namespace surf
