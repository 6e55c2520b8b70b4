// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_output.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "surf/core/error.h"

namespace surf::io {
namespace {

/// Appends numbers as their little-endian bytes, on any machine.
class LittleEndian {
 public:
  explicit LittleEndian(std::string& bytes) : bytes_(bytes) {}

  void add(double value) { add_bits(std::bit_cast<std::uint64_t>(value), 8); }
  void add(float value) { add_bits(std::bit_cast<std::uint32_t>(value), 4); }
  void add(std::uint32_t value) { add_bits(value, 4); }
  void add(std::uint8_t value) { add_bits(value, 1); }

 private:
  void add_bits(std::uint64_t bits, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<char>(bits >> (8 * i) & 0xff));
  }

  std::string& bytes_;
};

/// The unit normal; zero, as STL has it, for a triangle without area.
Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(b - a, c - a);
  const double size = length(normal);
  return size > 0 && std::isfinite(size) ? normal * (1 / size) : Vec3{};
}

void add_float32(LittleEndian& bytes, const Vec3& v, const std::string& file) {
  for (const double coordinate : {v.x, v.y, v.z}) {
    const auto value = static_cast<float>(coordinate);
    if (!std::isfinite(value)) {
      throw InvalidInput(file, fmt::format("the coordinate {} is too large for STL", coordinate),
                         "Write PLY, or use a larger unit");
    }
    bytes.add(value);
  }
}

[[noreturn]] void refuse_size(const std::string& file, const char* what, std::size_t count) {
  throw InvalidInput(file, fmt::format("the format cannot hold {} {}", count, what),
                     "Simplify the mesh");
}

/// Lines "PREFIX x y z", each number with as many digits as it takes to read the same double.
void add_vertex_lines(std::string& text, const TriangleMesh& mesh, const char* prefix) {
  for (const Vec3& v : mesh.vertices_nm) {
    fmt::format_to(std::back_inserter(text), "{}{} {} {}\n", prefix, v.x, v.y, v.z);
  }
}

void add_triangle_lines(std::string& text, const TriangleMesh& mesh, const char* prefix,
                        std::uint64_t first_index) {
  for (const Triangle& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(text), "{}{} {} {}\n", prefix, t[0] + first_index,
                   t[1] + first_index, t[2] + first_index);
  }
}

}  // namespace

std::string format_stl(const std::string& file, const TriangleMesh& mesh) {
  constexpr std::size_t header_bytes = 80;
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    refuse_size(file, "triangles", mesh.triangles.size());
  }
  std::string content = "binary STL written by semsurf";   // "solid" would announce text
  content.resize(header_bytes, ' ');
  content.reserve(header_bytes + 4 + 50 * mesh.triangles.size());
  LittleEndian bytes(content);
  bytes.add(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices_nm[t[0]];
    const Vec3& b = mesh.vertices_nm[t[1]];
    const Vec3& c = mesh.vertices_nm[t[2]];
    for (const Vec3& v : {normal_of(a, b, c), a, b, c}) add_float32(bytes, v, file);
    content.append(2, '\0');
  }
  return content;
}

std::string format_obj(const TriangleMesh& mesh) {
  std::string text = "# OBJ written by semsurf\n";
  add_vertex_lines(text, mesh, "v ");
  add_triangle_lines(text, mesh, "f ", 1);
  return text;
}

std::string format_ply(const std::string& file, const TriangleMesh& mesh) {
  // Signed indices, as most readers expect them.
  if (mesh.vertices_nm.size() > std::numeric_limits<std::int32_t>::max()) {
    refuse_size(file, "vertices", mesh.vertices_nm.size());
  }
  std::string content = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by semsurf\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      mesh.vertices_nm.size(), mesh.triangles.size());
  content.reserve(content.size() + 24 * mesh.vertices_nm.size() + 13 * mesh.triangles.size());
  LittleEndian bytes(content);
  for (const Vec3& v : mesh.vertices_nm) {
    for (const double coordinate : {v.x, v.y, v.z}) bytes.add(coordinate);
  }
  for (const Triangle& t : mesh.triangles) {
    bytes.add(std::uint8_t{3});
    for (const std::uint32_t corner : t) bytes.add(corner);
  }
  return content;
}

std::string format_off(const TriangleMesh& mesh) {
  std::string text =
      fmt::format("OFF\n{} {} 0\n", mesh.vertices_nm.size(), mesh.triangles.size());
  add_vertex_lines(text, mesh, "");
  add_triangle_lines(text, mesh, "3 ", 0);
  return text;
}

}  // namespace surf::io
