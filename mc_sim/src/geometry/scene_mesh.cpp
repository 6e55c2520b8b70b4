// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/scene_mesh.h"

namespace surf::mc {
namespace {

// What Embree may read beyond the last vertex, in floats.
constexpr std::size_t padding = 4;

}  // namespace

SceneMesh make_scene_mesh(TriangleMesh mesh, std::vector<std::uint32_t> shell_of) {
  SceneMesh out;
  out.center_nm = bounds(mesh).center_nm();
  std::vector<float> local;
  local.reserve(3 * mesh.vertices_nm.size() + padding);
  for (const Vec3& v : mesh.vertices_nm) {
    const Vec3 p = v - out.center_nm;
    for (const double x : {p.x, p.y, p.z}) local.push_back(static_cast<float>(x));
  }
  local.resize(local.size() + padding);
  out.vertices_nm = SharedArray<Vec3>(std::move(mesh.vertices_nm));
  out.triangles = SharedArray<Triangle>(std::move(mesh.triangles));
  out.shell_of = SharedArray<std::uint32_t>(std::move(shell_of));
  out.local_nm = SharedArray<float>(std::move(local));
  return out;
}

}  // namespace surf::mc
