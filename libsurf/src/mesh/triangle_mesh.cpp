// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/triangle_mesh.h"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "core/argument.h"
#include "mesh/weld.h"
#include "surf/core/error.h"

namespace surf {
namespace {

// Sides of triangles are numbered with 32 bits.
constexpr std::size_t max_triangles = std::numeric_limits<std::uint32_t>::max() / 3;

// 0 and -0 get the same bits. Equal NaNs do, too, which keeps the search for them short.
std::array<std::uint64_t, 3> coordinate_bits(const Vec3& v) {
  return {std::bit_cast<std::uint64_t>(v.x + 0.0), std::bit_cast<std::uint64_t>(v.y + 0.0),
          std::bit_cast<std::uint64_t>(v.z + 0.0)};
}

std::uint64_t hash(const std::array<std::uint64_t, 3>& bits) {
  std::uint64_t h = 0;
  for (const std::uint64_t word : bits) {
    h = (h ^ word) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return h * 0xbf58476d1ce4e5b9u >> 16;
}

void mark_used(const TriangleMesh& mesh, std::vector<std::uint32_t>& point) {
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) point[corner] = 0;
  }
}

}  // namespace

Weld weld_equal_vertices(const TriangleMesh& mesh) {
  const auto& vertices = mesh.vertices_nm;
  Weld weld;
  weld.point.assign(vertices.size(), Weld::unused);
  mark_used(mesh, weld.point);

  // Open addressing with linear probing, at most half full.
  const std::size_t slots = std::bit_ceil(2 * vertices.size() + 1);
  std::vector<std::uint32_t> table(slots, Weld::unused);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (weld.point[i] == Weld::unused) continue;
    const auto bits = coordinate_bits(vertices[i]);
    std::size_t slot = hash(bits) & (slots - 1);
    while (table[slot] != Weld::unused &&
           coordinate_bits(vertices[weld.first_vertex[table[slot]]]) != bits) {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] == Weld::unused) {
      table[slot] = static_cast<std::uint32_t>(weld.points());
      weld.first_vertex.push_back(static_cast<std::uint32_t>(i));
    }
    weld.point[i] = table[slot];
  }
  return weld;
}

Box bounds(const TriangleMesh& mesh) {
  Box box;
  for (const Vec3& v : mesh.vertices_nm) box.extend(v);
  return box;
}

void transform(TriangleMesh& mesh, double factor, const Vec3& offset_nm) {
  require_positive(factor, "scale factor");
  require_finite(offset_nm.x, "offset along x");
  require_finite(offset_nm.y, "offset along y");
  require_finite(offset_nm.z, "offset along z");
  for (Vec3& v : mesh.vertices_nm) v = v * factor + offset_nm;
}

TriangleMesh merge_equal_vertices(const TriangleMesh& mesh) {
  const Weld weld = weld_equal_vertices(mesh);
  TriangleMesh merged;
  merged.vertices_nm.reserve(weld.points());
  for (const std::uint32_t vertex : weld.first_vertex) {
    merged.vertices_nm.push_back(mesh.vertices_nm[vertex]);
  }
  merged.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) merged.triangles.push_back(weld(t));
  return merged;
}

void validate(const TriangleMesh& mesh, const char* subject) {
  if (mesh.triangles.empty()) {
    throw InvalidInput(subject, "it has no triangles", "Give a surface made of triangles");
  }
  if (mesh.triangles.size() > max_triangles) {
    throw Unsupported(subject, fmt::format("it has {} triangles", mesh.triangles.size()),
                      fmt::format("{} is the most: cut it into pieces", max_triangles));
  }
  for (std::size_t i = 0; i < mesh.vertices_nm.size(); ++i) {
    const Vec3& v = mesh.vertices_nm[i];
    if (is_finite(v)) continue;
    throw InvalidInput(subject, fmt::format("vertex {} is ({}, {}, {})", i, v.x, v.y, v.z),
                       "Coordinates must be finite: export the mesh again or remove the vertex");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner < mesh.vertices_nm.size()) continue;
      throw InvalidInput(subject,
                         fmt::format("triangle {} has the corner {}, but there are {} vertices", i,
                                     corner, mesh.vertices_nm.size()),
                         "The mesh is damaged: export it again");
    }
  }
}

}  // namespace surf
