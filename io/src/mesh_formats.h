// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "surf/mesh/triangle_mesh.h"

namespace surf::io {

// One parser per format, behind read_mesh. `file` is the name for messages. The result is in file
// units, with the file's own vertices (not merged), finite and with indices in range; it may have
// no triangles.

TriangleMesh parse_stl(const std::string& file, std::string_view content);
TriangleMesh parse_obj(const std::string& file, std::string_view content);
TriangleMesh parse_ply(const std::string& file, std::string_view content);
TriangleMesh parse_off(const std::string& file, std::string_view content);

/// Whether the length is that which the count in a binary STL file demands.
bool is_binary_stl(std::string_view content);
/// "solid" and then, somewhere, "facet".
bool is_text_stl(std::string_view content);
bool is_ply(std::string_view content);
/// A first word that ends in "OFF".
bool is_off(std::string_view content);

/// Splits a polygon into triangles around its first corner.
inline void add_fan(const std::vector<std::uint32_t>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

inline constexpr std::uint64_t max_mesh_vertices = std::uint64_t{1} << 32;

}  // namespace surf::io
