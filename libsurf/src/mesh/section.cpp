// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/section.h"

namespace surf {

std::vector<std::array<Vec3, 2>> section_at_y(const TriangleMesh& mesh, double y_nm) {
  std::vector<std::array<Vec3, 2>> pieces;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3, 2> ends;
    int count = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3& a = mesh.vertices_nm[t[static_cast<std::size_t>(i)]];
      const Vec3& b = mesh.vertices_nm[t[static_cast<std::size_t>((i + 1) % 3)]];
      if ((a.y < y_nm) == (b.y < y_nm)) continue;  // a corner in the plane counts as above it
      Vec3& p = ends[static_cast<std::size_t>(count++)];
      p = a + (b - a) * ((y_nm - a.y) / (b.y - a.y));
      p.y = y_nm;
    }
    if (count == 2 && !(ends[0] == ends[1])) pieces.push_back(ends);
  }
  return pieces;
}

}  // namespace surf
