// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/vertex_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace surf {
namespace {

/// The sides of a triangle, scaled to length 1 or less, so that products neither overflow nor
/// vanish.
std::array<Vec3, 3> scaled_sides(const TriangleMesh& mesh, const Triangle& t) {
  const auto& v = mesh.vertices_nm;
  std::array<Vec3, 3> sides{v[t[1]] * 0.25 - v[t[0]] * 0.25, v[t[2]] * 0.25 - v[t[1]] * 0.25,
                            v[t[0]] * 0.25 - v[t[2]] * 0.25};
  double largest = 0;
  for (const Vec3& s : sides) {
    largest = std::max({largest, std::abs(s.x), std::abs(s.y), std::abs(s.z)});
  }
  if (!(largest > 0)) return {};
  for (Vec3& s : sides) s = {s.x / largest, s.y / largest, s.z / largest};
  return sides;
}

}  // namespace

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices_nm.size());
  for (const Triangle& t : mesh.triangles) {
    const std::array<Vec3, 3> sides = scaled_sides(mesh, t);
    const Vec3 area = cross(sides[0], sides[1]);
    const double size = length(area);
    if (!(size > 0)) continue;
    const Vec3 normal = area * (1 / size);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const double cosine = -dot(sides[corner], sides[(corner + 2) % 3]);
      normals[t[corner]] += normal * std::atan2(size, cosine);
    }
  }
  constexpr double cancelled = 1e-12;  // compared to angles of pi/3
  for (Vec3& normal : normals) {
    const double size = length(normal);
    normal = size > cancelled ? normal * (1 / size) : Vec3{0, 0, 1};
  }
  return normals;
}

}  // namespace surf
