// SPDX-License-Identifier: GPL-3.0-or-later
#include "relief_box.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace surf::workflow {
namespace {

constexpr double least_relief = 0.1;  // of the height, above or below the ground

}  // namespace

Box relief_box(const TriangleMesh& mesh, const Box& seen) {
  std::vector<std::pair<double, double>> areas;  // height, area of level triangles
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices_nm[t[0]], &b = mesh.vertices_nm[t[1]],
               &c = mesh.vertices_nm[t[2]];
    const Vec3 normal = cross(b - a, c - a);
    if (normal.z > 0.9 * length(normal)) areas.push_back({(a.z + b.z + c.z) / 3, normal.z});
  }
  std::ranges::sort(areas);
  double all = 0, sum = 0, ground = 0;
  for (const auto& [z, area] : areas) all += area;
  for (const auto& [z, area] : areas) {
    sum += area, ground = z;
    if (sum > 0.5 * all) break;
  }
  Box inside, out;
  const auto is_seen = [&](const Vec3& p) {
    return p.x >= seen.lower_nm.x && p.x <= seen.upper_nm.x && p.y >= seen.lower_nm.y &&
           p.y <= seen.upper_nm.y;
  };
  for (const Vec3& p : mesh.vertices_nm)
    if (is_seen(p)) inside.extend(p);
  if (inside.empty()) return seen;
  const double least = least_relief * inside.size_nm().z;
  for (const Vec3& p : mesh.vertices_nm)
    if (is_seen(p) && std::abs(p.z - ground) > least) out.extend(p);
  if (out.empty()) return inside;
  out.lower_nm.z = inside.lower_nm.z, out.upper_nm.z = inside.upper_nm.z;
  return out;
}

}  // namespace surf::workflow
