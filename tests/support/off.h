// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "surf/mesh/triangle_mesh.h"

namespace surf::test {

/// A file of the test data, or nothing where SEMSURF_TEST_DATA is unset or lacks it.
inline std::optional<std::filesystem::path> test_data(const std::string& name) {
  const char* folder = std::getenv("SEMSURF_TEST_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

/// The text of a file without comments, which run from # to the end of a line.
inline std::stringstream without_comments(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::stringstream text;
  for (std::string line; std::getline(in, line);) text << line.substr(0, line.find('#')) << '\n';
  return text;
}

/// Reads a plain OFF file; polygons become fans. Tests of libsurf use it, which knows no files.
inline TriangleMesh read_off(const std::filesystem::path& path) {
  std::stringstream in = without_comments(path);
  std::string magic;
  std::size_t vertices = 0;
  std::size_t polygons = 0;
  std::size_t edges = 0;
  in >> magic >> vertices >> polygons >> edges;
  if (!in || magic != "OFF") throw std::runtime_error(path.string() + ": not a plain OFF file");

  TriangleMesh mesh;
  mesh.vertices_nm.resize(vertices);
  for (Vec3& v : mesh.vertices_nm) in >> v.x >> v.y >> v.z;
  for (std::size_t p = 0; p < polygons; ++p) {
    std::size_t corners = 0;
    std::uint32_t first = 0;
    std::uint32_t previous = 0;
    std::uint32_t corner = 0;
    in >> corners >> first >> previous;
    for (std::size_t k = 2; k < corners; ++k) {
      in >> corner;
      mesh.triangles.push_back({first, previous, corner});
      previous = corner;
    }
    std::string colours;
    std::getline(in, colours);
  }
  if (!in) throw std::runtime_error(path.string() + ": ends too early");
  return mesh;
}

}  // namespace surf::test
