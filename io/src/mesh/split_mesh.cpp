// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_mesh.h"

#include <algorithm>

namespace surf::io {
namespace {

constexpr std::uint32_t unused = ~std::uint32_t{0};

std::vector<std::vector<std::uint32_t>> members(const std::vector<std::uint32_t>& group,
                                                std::size_t groups) {
  std::vector<std::vector<std::uint32_t>> triangles(groups);
  for (std::size_t t = 0; t < group.size(); ++t) {
    triangles[group[t]].push_back(static_cast<std::uint32_t>(t));
  }
  return triangles;
}

}  // namespace

std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& group, std::size_t groups) {
  std::vector<TriangleMesh> parts(groups);
  std::vector<std::uint32_t> place(mesh.vertices_nm.size(), unused);
  const auto triangles = members(group, groups);
  for (std::size_t g = 0; g < groups; ++g) {
    TriangleMesh& part = parts[g];
    for (const std::uint32_t t : triangles[g]) {
      Triangle moved = mesh.triangles[t];
      for (std::uint32_t& corner : moved) {
        if (place[corner] == unused) {
          place[corner] = static_cast<std::uint32_t>(part.vertices_nm.size());
          part.vertices_nm.push_back(mesh.vertices_nm[corner]);
        }
        corner = place[corner];
      }
      part.triangles.push_back(moved);
    }
    for (const std::uint32_t t : triangles[g]) {
      for (const std::uint32_t corner : mesh.triangles[t]) place[corner] = unused;
    }
  }
  return parts;
}

std::vector<MeshPart> split_in_order(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& group, std::size_t groups) {
  const auto triangles = members(group, groups);
  const std::size_t n = mesh.vertices_nm.size();
  std::vector<MeshPart> parts(groups);
  std::vector<std::uint32_t> last_group(n, unused);  // the latest one that a vertex was given to
  for (std::size_t g = 0; g < groups; ++g) {
    for (const std::uint32_t t : triangles[g]) {
      for (const std::uint32_t corner : mesh.triangles[t]) {
        if (last_group[corner] == g) continue;
        last_group[corner] = static_cast<std::uint32_t>(g);
        parts[g].vertices.push_back(corner);
      }
    }
  }
  std::uint32_t home = 0;
  for (std::size_t v = 0; v < n && groups > 0; ++v) {
    if (last_group[v] == unused) parts[home].vertices.push_back(static_cast<std::uint32_t>(v));
    else home = last_group[v];
  }
  std::vector<std::uint32_t> place(n);
  for (std::size_t g = 0; g < groups; ++g) {
    MeshPart& part = parts[g];
    std::sort(part.vertices.begin(), part.vertices.end());
    for (const std::uint32_t v : part.vertices) {
      place[v] = static_cast<std::uint32_t>(part.mesh.vertices_nm.size());
      part.mesh.vertices_nm.push_back(mesh.vertices_nm[v]);
    }
    for (const std::uint32_t t : triangles[g]) {
      const Triangle& old = mesh.triangles[t];
      part.mesh.triangles.push_back({place[old[0]], place[old[1]], place[old[2]]});
    }
  }
  return parts;
}

void append(TriangleMesh& mesh, const TriangleMesh& addition) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.insert(mesh.vertices_nm.end(), addition.vertices_nm.begin(),
                          addition.vertices_nm.end());
  mesh.triangles.reserve(mesh.triangles.size() + addition.triangles.size());
  for (const Triangle& t : addition.triangles) {
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

}  // namespace surf::io
