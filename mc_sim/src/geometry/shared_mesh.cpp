// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/shared_mesh.h"

#include <algorithm>
#include <cstring>
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

struct Sizes {
  std::uint64_t vertices = 0, triangles = 0;
  Vec3 center;
};

constexpr std::size_t round_up(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

// What lies where in memory that is shared.
struct Layout {
  explicit Layout(const Sizes& s)
      : triangles(round_up(s.vertices * sizeof(Vec3))),
        shell_of(triangles + round_up(s.triangles * sizeof(Triangle))),
        local(shell_of + round_up(s.triangles * sizeof(std::uint32_t))),
        end(local + round_up((3 * s.vertices + padding) * sizeof(float))) {}
  std::size_t triangles, shell_of, local, end;
};

}  // namespace

SceneMesh share_scene_mesh(NodeMemory& node, TriangleMesh mesh, std::vector<std::uint32_t> shell_of) {
  Sizes sizes{mesh.vertices_nm.size(), mesh.triangles.size(), bounds(MeshView(mesh)).center_nm()};
  std::string text(reinterpret_cast<const char*>(&sizes), sizeof sizes);
  node.tell(text);
  std::memcpy(&sizes, text.data(), sizeof sizes);
  const Layout layout(sizes);
  const std::shared_ptr<std::byte> memory = node.allocate(layout.end);
  std::byte* const at = memory.get();
  auto* const vertices = reinterpret_cast<Vec3*>(at);
  auto* const triangles = reinterpret_cast<Triangle*>(at + layout.triangles);
  auto* const shells = reinterpret_cast<std::uint32_t*>(at + layout.shell_of);
  auto* const local = reinterpret_cast<float*>(at + layout.local);
  SceneMesh out;
  out.mesh.vertices_nm = {vertices, sizes.vertices};
  out.mesh.triangles = {triangles, sizes.triangles};
  if (node.is_first()) {
    std::ranges::copy(mesh.vertices_nm, vertices);
    mesh.vertices_nm = {};   // one copy at a time
    std::ranges::copy(mesh.triangles, triangles);
    mesh.triangles = {};
    std::ranges::copy(shell_of, shells);
    fill_local(out.mesh, sizes.center, local);
    std::fill_n(local + 3 * sizes.vertices, padding, 0.0f);
  }
  node.share(at, layout.end);
  out.shell_of = {shells, sizes.triangles};
  out.local = {local, 3 * sizes.vertices + padding};
  out.center = sizes.center;
  out.owner = memory;
  return out;
}

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
