// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_view.h"

#include <utility>

namespace surf::mc {

namespace {

struct Held {
  TriangleMesh mesh;
  std::vector<std::uint32_t> shell_of;
  std::vector<float> local;
};

// What Embree may read beyond the last vertex, in floats.
constexpr std::size_t padding = 4;

void fill_local(const MeshView& mesh, const Vec3& center, float* out) {
  for (const Vec3& v : mesh.vertices_nm) {
    const Vec3 local = v - center;
    *out++ = static_cast<float>(local.x);
    *out++ = static_cast<float>(local.y);
    *out++ = static_cast<float>(local.z);
  }
}

}  // namespace

SceneMesh make_scene_mesh(TriangleMesh mesh, std::vector<std::uint32_t> shell_of) {
  const auto held = std::make_shared<Held>();
  held->mesh = std::move(mesh);
  held->shell_of = std::move(shell_of);
  SceneMesh out;
  out.mesh = held->mesh;
  out.shell_of = held->shell_of;
  out.center = bounds(out.mesh).center_nm();
  held->local.resize(3 * held->mesh.vertices_nm.size() + padding);
  fill_local(out.mesh, out.center, held->local.data());
  out.local = held->local;
  out.owner = held;
  return out;
}

}  // namespace surf::mc
