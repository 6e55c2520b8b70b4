// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_output.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>

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
  void add_bits(std::uint64_t bits, std::size_t count) {
    std::array<char, 8> text;
    for (std::size_t i = 0; i < 8; ++i) text[i] = static_cast<char>(bits >> (8 * i) & 0xff);
    bytes_.append(text.data(), count);
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

/// "PREFIX x y z", each number with as many digits as it takes to read the same double.
void add_vertex_line(std::string& text, const Vec3& v, const char* prefix) {
  fmt::format_to(std::back_inserter(text), "{}{} {} {}\n", prefix, v.x, v.y, v.z);
}

/// A line for each of the entries, as a comment.
std::string comments(const SurfaceNote& note, bool magnified, const char* prefix) {
  std::string text;
  for (const auto& [key, value] : to_entries(note, magnified)) {
    text += fmt::format("{}{}\n", prefix, to_line(key, value));
  }
  return text;
}

/// Names that PLY's readers take for something else.
bool is_taken_in_ply(const std::string& name) {
  static const std::set<std::string> taken{"x", "y", "z", "nx",  "ny",    "nz",   "s",
                                           "t", "u", "v", "red", "green", "blue", "alpha"};
  return taken.contains(name);
}

}  // namespace

std::vector<std::vector<const VertexScalar*>> common_scalars(const SceneView& scene) {
  std::vector<std::vector<const VertexScalar*>> common;
  for (const VertexScalar& first : scene.surfaces.front().scalars) {
    std::vector<const VertexScalar*> found;
    for (const SurfaceView& surface : scene.surfaces) {
      for (const VertexScalar& scalar : surface.scalars) {
        if (scalar.name == first.name && scalar.unit == first.unit) found.push_back(&scalar);
      }
    }
    if (found.size() == scene.surfaces.size()) common.push_back(std::move(found));
  }
  return common;
}

std::string format_stl(const std::string& file, const SceneView& scene) {
  const std::size_t count = count_triangles(scene);
  if (count > std::numeric_limits<std::uint32_t>::max()) refuse_size(file, "triangles", count);
  std::string content = to_stl_header(scene.note);  // "solid" would announce text
  content.reserve(content.size() + 4 + 50 * count);
  LittleEndian bytes(content);
  bytes.add(static_cast<std::uint32_t>(count));
  for (const SurfaceView& surface : scene.surfaces) {
    const auto corner = [&](std::uint32_t v) {
      return scene.note.to_file(surface.mesh->vertices_nm[v]);
    };
    for (const Triangle& t : surface.mesh->triangles) {
      const Vec3 a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
      for (const Vec3& v : {normal_of(a, b, c), a, b, c}) add_float32(bytes, v, file);
      content.append(2, '\0');
    }
  }
  return content;
}

std::string format_ply(const std::string& file, const SceneView& scene) {
  const std::size_t vertices = count_vertices(scene);
  // Signed indices, as most readers expect them.
  if (vertices > std::numeric_limits<std::int32_t>::max()) refuse_size(file, "vertices", vertices);
  const auto scalars = common_scalars(scene);
  SurfaceNote note = scene.note;
  std::string properties;
  for (const auto& scalar : scalars) {
    const std::string& name = scalar.front()->name;
    if (is_taken_in_ply(name)) {
      throw InvalidInput(
          file,
          fmt::format("a scalar cannot be called '{}' in PLY, where this has a meaning", name),
          "Give it a longer name");
    }
    properties += fmt::format("property float {}\n", name);
    note.scalar_units[name] = scalar.front()->unit;
  }
  std::string content = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by semsurf\n{}element vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n{}element face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      comments(note, false, "comment "), vertices, properties, count_triangles(scene));
  content.reserve(content.size() + (24 + 4 * scalars.size()) * vertices +
                  13 * count_triangles(scene));
  LittleEndian bytes(content);
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const auto& places = scene.surfaces[s].mesh->vertices_nm;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec3 v = note.to_file(places[i]);
      for (const double coordinate : {v.x, v.y, v.z}) bytes.add(coordinate);
      for (const auto& scalar : scalars) bytes.add(scalar[s]->values[i]);
    }
  }
  std::uint32_t first = 0;
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Triangle& t : surface.mesh->triangles) {
      bytes.add(std::uint8_t{3});
      for (const std::uint32_t corner : t) bytes.add(first + corner);
    }
    first += static_cast<std::uint32_t>(surface.mesh->vertices_nm.size());
  }
  return content;
}

std::string format_off(const SceneView& scene) {
  std::string text = fmt::format("OFF\n{}{} {} 0\n", comments(scene.note, false, "# "),
                                 count_vertices(scene), count_triangles(scene));
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Vec3& v : surface.mesh->vertices_nm)
      add_vertex_line(text, scene.note.to_file(v), "");
  }
  std::uint64_t first = 0;
  for (const SurfaceView& surface : scene.surfaces) {
    for (const Triangle& t : surface.mesh->triangles) {
      fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", first + t[0], first + t[1],
                     first + t[2]);
    }
    first += surface.mesh->vertices_nm.size();
  }
  return text;
}

std::vector<OutputFile> format_obj(const std::filesystem::path& path, const SceneView& scene) {
  const std::string stem = path.stem().string();
  if (stem.find_first_of("\n\r") != stem.npos) {
    throw UsageError(path.string(), "OBJ cannot name a file whose name has line ends",
                     "Choose another name");
  }
  std::vector<OutputFile> files;
  SurfaceNote note = scene.note;
  std::string materials = "# written by semsurf\n";
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (!scene.surfaces[s].drape) continue;
    const std::string picture = fmt::format("{}_drape{}.png", stem, s + 1);
    materials += fmt::format("\nnewmtl drape{}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n",
                             s + 1, picture);
    note.drapes[s] = picture;
    files.push_back(
        {path.parent_path() / picture, format_drape(path.string(), *scene.surfaces[s].drape)});
  }
  std::string text = fmt::format(
      "# OBJ written by semsurf. Taken for millimetres, it shows the specimen {} times "
      "larger{}.\n{}",
      note.magnification,
      note.z_exaggeration == 1 ? ""
                               : fmt::format(", its heights another {} times", note.z_exaggeration),
      comments(note, true, "# "));
  if (!files.empty()) {
    text += fmt::format("mtllib {}.mtl\n", stem);
    files.push_back({path.parent_path() / (stem + ".mtl"), std::move(materials)});
  }
  std::uint64_t first = 1, first_texture = 1;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const SurfaceView& surface = scene.surfaces[s];
    const auto& places = surface.mesh->vertices_nm;
    text += fmt::format("o {}\n", plain_name(surface.name));
    for (const Vec3& v : places) add_vertex_line(text, note.to_file(v), "v ");
    if (!surface.drape) {
      for (const Triangle& t : surface.mesh->triangles) {
        fmt::format_to(std::back_inserter(text), "f {} {} {}\n", first + t[0], first + t[1],
                       first + t[2]);
      }
    } else {
      for (const Vec3& v : places) {
        const TexturePoint p = texture_point(*surface.drape, v);
        fmt::format_to(std::back_inserter(text), "vt {:.9g} {:.9g}\n", p.u, p.v);
      }
      text += fmt::format("usemtl drape{}\n", s + 1);
      for (const Triangle& t : surface.mesh->triangles) {
        fmt::format_to(std::back_inserter(text), "f {}/{} {}/{} {}/{}\n", first + t[0],
                       first_texture + t[0], first + t[1], first_texture + t[1], first + t[2],
                       first_texture + t[2]);
      }
      first_texture += places.size();
    }
    first += places.size();
  }
  files.push_back({path, std::move(text)});
  return files;
}

}  // namespace surf::io
