// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf::test {

/// An upright "F" of cubes as one closed surface of squares, normals outward. Mirroring it or
/// exchanging axes shows.
struct QuadMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 4>> quads;
};

inline bool in_letter_f(int x, int y, int z) {
  const char* const rows[5] = {"###", "#..", "##.", "#..", "#.."};
  return x >= 0 && x < 3 && y >= 0 && y < 5 && z == 0 && rows[4 - y][x] == '#';
}

inline std::uint32_t vertex_index(QuadMesh& mesh, const Vec3& v) {
  const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), v);
  if (found == mesh.vertices.end()) mesh.vertices.push_back(v);
  return static_cast<std::uint32_t>(std::find(mesh.vertices.begin(), mesh.vertices.end(), v) -
                                    mesh.vertices.begin());
}

inline void add_side(QuadMesh& mesh, const std::array<int, 3>& cube, std::size_t axis, int side) {
  std::array<std::uint32_t, 4> quad{};
  const int turn[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 3> p{};
    p[axis] = cube[axis] + side;
    p[(axis + 1) % 3] = cube[(axis + 1) % 3] + turn[i][0];
    p[(axis + 2) % 3] = cube[(axis + 2) % 3] + turn[i][1];
    quad[side == 1 ? i : 3 - i] = vertex_index(mesh, {p[0], 0.5 * p[1], 0.25 * p[2]});
  }
  mesh.quads.push_back(quad);
}

inline QuadMesh letter_f_quads() {
  QuadMesh mesh;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 5; ++y) {
      if (!in_letter_f(x, y, 0)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
          std::array<int, 3> next{x, y, 0};
          next[axis] += side == 1 ? 1 : -1;
          if (!in_letter_f(next[0], next[1], next[2])) add_side(mesh, {x, y, 0}, axis, side);
        }
      }
    }
  }
  return mesh;
}

inline TriangleMesh letter_f_triangles() {
  const QuadMesh quads = letter_f_quads();
  TriangleMesh mesh{quads.vertices, {}};
  for (const auto& q : quads.quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// The corners of all triangles, in order.
inline std::vector<std::array<Vec3, 3>> corners(const TriangleMesh& mesh) {
  std::vector<std::array<Vec3, 3>> result;
  const auto& v = mesh.vertices_nm;
  for (const Triangle& t : mesh.triangles) {
    result.push_back({v.at(t[0]), v.at(t[1]), v.at(t[2])});
  }
  return result;
}

inline std::string text_stl(const TriangleMesh& mesh) {
  std::string text = "solid letter F\n";
  for (const auto& t : corners(mesh)) {
    text += "  facet normal nan 0 0\n    outer loop\n";
    for (const Vec3& v : t) text += fmt::format("      vertex {:e} {} {}\n", v.x, v.y, v.z);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid letter F\n";
}

template <class T>
std::string bytes(T value, bool big_endian) {
  std::string text(sizeof value, '\0');
  std::memcpy(text.data(), &value, sizeof value);
  const bool is_big = std::endian::native == std::endian::big;
  if (big_endian != is_big) std::reverse(text.begin(), text.end());
  return text;
}

/// The header begins with "solid", as that of many programs.
inline std::string binary_stl(const TriangleMesh& mesh) {
  std::string text = "solid but binary, facet";
  text.resize(80, ' ');
  text += bytes(static_cast<std::uint32_t>(mesh.triangles.size()), false);
  for (const auto& t : corners(mesh)) {
    text += std::string(12, '\xff');  // a normal of NaN
    for (const Vec3& v : t) {
      for (const double c : {v.x, v.y, v.z}) text += bytes(static_cast<float>(c), false);
    }
    text += "\x01\x02";
  }
  return text;
}

}  // namespace surf::test
