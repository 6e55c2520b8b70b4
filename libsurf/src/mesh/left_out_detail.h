// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/original_section.h"
#include "surf/mesh/triangle_mesh.h"
#include "surf/mesh/triangle_tree.h"

namespace surf {

/// What merging one vertex into a neighbour would do. Vertices are numbers of the original mesh;
/// faces are any numbers.
struct Merger {
  struct NewFace {
    std::uint32_t face;
    Triangle vertices;
    Corners corners;
    Vec3 normal;  ///< any length
  };
  std::uint32_t vertex = 0;
  std::uint32_t target = 0;
  std::vector<std::uint32_t> old_faces;  ///< around the vertex
  std::vector<NewFace> new_faces;        ///< in order around the vertex; some of the old ones
  std::vector<std::uint32_t> rim;        ///< rim[i] is between the new faces i and i + 1
};

/// Tells whether a merger keeps the surface near the original one: every vertex left out so far
/// belongs to a face, from which it must not be far; nor may the original be far where it passes
/// below or above a new edge. That is where two surfaces over one plane differ most. Where they are
/// not over one plane this is only likely: it is no proof.
class LeftOutDetail {
 public:
  /// `mesh` must outlive this. Faces are numbered from 0 to `faces` - 1.
  LeftOutDetail(const TriangleMesh& mesh, std::size_t faces, double tolerance_nm,
                const Watch& watch);

  /// Whether the merger keeps the tolerance.
  bool allows(const Merger& merger);
  /// Does what `allows` was last asked about.
  void perform(const Merger& merger);

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::uint32_t most_points = 128;  // of a face

  bool faces_out(const Merger::NewFace& face) const;
  bool settle(const Merger& merger, std::uint32_t vertex);
  void add(std::uint32_t face, std::uint32_t vertex);
  void thin(std::uint32_t face);

  const TriangleMesh& mesh_;
  OriginalSection section_;
  std::vector<Vec3> normals_;         // of the original's vertices
  std::vector<double> least_cosine_;  // to them, of the normals of new faces
  double squared_nm_;
  std::vector<std::uint32_t> first_, count_;  // of a face
  std::vector<std::uint32_t> next_;           // of a vertex
  struct Home {
    std::uint32_t vertex, face;
  };
  std::vector<Home> homes_;
};

}  // namespace surf
