// SPDX-License-Identifier: GPL-3.0-or-later
#include "share_surfaces.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>

#include "surf/workflow/team.h"

namespace surf::workflow {
namespace {

// All data of fixed size.
struct Header {
  std::uint64_t shells = 0, solids = 0, vertices = 0, triangles = 0, local = 0,
                triangles_left_out = 0;
  std::optional<double> plane_nm;
  Box box;
  Vec3 center_nm;
  double build_seconds = 0;
  bool half_space = false;
};

template <class T>
void put(std::string& text, const T* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  text.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
void get(const std::string& text, std::size_t& at, T* values, std::size_t count) {
  std::memcpy(values, text.data() + at, count * sizeof(T));
  at += count * sizeof(T);
}

std::string pack(const mc::SceneSurfaces& s) {
  const Header header{s.shells.size(),
                      s.solids.size(),
                      s.mesh.vertices_nm.values.size(),
                      s.mesh.triangles.values.size(),
                      s.mesh.local_nm.values.size(),
                      s.triangles_left_out,
                      s.plane_nm,
                      s.box,
                      s.mesh.center_nm,
                      s.build_seconds,
                      s.half_space};
  std::string text;
  put(text, &header, 1);
  put(text, s.shells.data(), s.shells.size());
  put(text, s.solids.data(), s.solids.size());
  return text;
}

Header unpack(const std::string& text, mc::SceneSurfaces& s) {
  Header header;
  std::size_t at = 0;
  get(text, at, &header, 1);
  s.shells.resize(header.shells);
  s.solids.resize(header.solids);
  get(text, at, s.shells.data(), header.shells);
  get(text, at, s.solids.data(), header.solids);
  s.triangles_left_out = header.triangles_left_out;
  s.plane_nm = header.plane_nm;
  s.box = header.box;
  s.mesh.center_nm = header.center_nm;
  s.build_seconds = header.build_seconds;
  s.half_space = header.half_space;
  return header;
}

// The places of arrays in the shared memory.
class Layout {
 public:
  template <class T>
  std::size_t place(std::uint64_t count) {
    const std::size_t at = end_;
    end_ += (count * sizeof(T) + 63) / 64 * 64;
    return at;
  }
  std::size_t bytes() const { return end_; }

 private:
  std::size_t end_ = 0;
};

// Moves an array to a place in the shared memory and frees its old memory.
template <class T>
void move_to(const std::shared_ptr<std::byte>& memory, std::size_t place, std::uint64_t count,
             bool fill, mc::SharedArray<T>& array) {
  auto* const values = reinterpret_cast<T*>(memory.get() + place);
  if (fill) std::ranges::copy(array.values, values);
  array = mc::SharedArray<T>(std::span<const T>(values, count), memory);
}

}  // namespace

mc::SceneSurfaces share_surfaces(NodeMemory& node, const std::function<mc::SceneSurfaces()>& make) {
  mc::SceneSurfaces surfaces;
  const std::string text = once_per_node(&node, [&] {
    surfaces = make();
    return pack(surfaces);
  });
  const Header header = unpack(text, surfaces);
  if (header.triangles == 0) return surfaces;
  Layout layout;
  const std::size_t vertices = layout.place<Vec3>(header.vertices),
                    triangles = layout.place<Triangle>(header.triangles),
                    shells = layout.place<std::uint32_t>(header.triangles),
                    local = layout.place<float>(header.local);
  const std::shared_ptr<std::byte> memory = node.allocate(layout.bytes());
  const bool fill = node.is_first();
  move_to(memory, vertices, header.vertices, fill, surfaces.mesh.vertices_nm);
  move_to(memory, triangles, header.triangles, fill, surfaces.mesh.triangles);
  move_to(memory, shells, header.triangles, fill, surfaces.mesh.shell_of);
  move_to(memory, local, header.local, fill, surfaces.mesh.local_nm);
  node.share(memory.get(), layout.bytes());
  return surfaces;
}

}  // namespace surf::workflow
