// SPDX-License-Identifier: GPL-3.0-or-later
#include "text_output.h"

#include <fmt/format.h>

#include <iterator>

#include "surf/core/error.h"

namespace surf::io {

void refuse_size(const std::string& file, const char* what, std::size_t count) {
  throw InvalidInput(file, fmt::format("the format cannot hold {} {}", count, what),
                     "Simplify the mesh");
}

std::size_t count_vertices(const SceneView& scene) {
  std::size_t count = 0;
  for (const SurfaceView& surface : scene.surfaces) count += surface.mesh->vertices_nm.size();
  return count;
}

std::size_t count_triangles(const SceneView& scene) {
  std::size_t count = 0;
  for (const SurfaceView& surface : scene.surfaces) count += surface.mesh->triangles.size();
  return count;
}

void add_vertex_line(std::string& text, const Vec3& v, const char* prefix) {
  fmt::format_to(std::back_inserter(text), "{}{} {} {}\n", prefix, v.x, v.y, v.z);
}

std::string comments(const SurfaceNote& note, bool magnified, const char* prefix) {
  std::string text;
  for (const auto& [key, value] : to_entries(note, magnified)) {
    text += fmt::format("{}{}\n", prefix, to_line(key, value));
  }
  return text;
}

}  // namespace surf::io
