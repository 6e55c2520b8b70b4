// SPDX-License-Identifier: GPL-3.0-or-later
// Section numbers are those of the glTF 2.0 specification (Khronos Group, ISO/IEC 12113:2022).
#include "gltf_primitive.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mesh_formats.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

/// Vertices and indices in a scene, copies included.
constexpr std::uint64_t max_gltf_size = std::uint64_t{1} << 28;

/// 3.7.2.1: which corners make the triangles of lists (4), strips (5) and fans (6).
std::vector<Triangle> assemble(std::uint64_t mode, const std::vector<std::uint32_t>& corners,
                               const JsonValue& primitive) {
  const std::size_t n = corners.size();
  std::vector<Triangle> triangles;
  if (mode == 4) {
    if (n % 3 != 0) {
      primitive.fail(fmt::format("{} corners do not make whole triangles", n));
    }
    for (std::size_t i = 0; i < n; i += 3) {
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
    return triangles;
  }
  if (mode == 5) {
    add_strip(corners, triangles);
  } else {
    add_fan(corners, triangles);
  }
  return triangles;
}

std::vector<std::uint32_t> corners_of(GltfDocument& document, const JsonValue& primitive,
                                      std::size_t vertices) {
  std::vector<std::uint32_t> corners;
  const auto indices = primitive.find("indices");
  if (indices) {
    corners = document.accessors.indices(indices->whole());
  } else {
    corners.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::uint32_t>(i);
  }
  const auto highest = std::max_element(corners.begin(), corners.end());
  if (highest != corners.end() && *highest >= vertices) {
    primitive.fail(fmt::format("a corner names vertex {}, but they run from 0 to {}", *highest,
                               static_cast<std::int64_t>(vertices) - 1));
  }
  return corners;
}

/// Compression that is not required comes with plain data, or with accessors that have none.
void refuse_compressed(const GltfDocument& document, const JsonValue& primitive) {
  const auto extensions = primitive.find("extensions");
  if (!extensions || !extensions->find("KHR_draco_mesh_compression")) return;
  const auto position = primitive.require("attributes").require("POSITION").whole();
  if (document.root.item("accessors", position).find("bufferView")) return;
  throw Unsupported(primitive.place(), "it is compressed with Draco, which cannot be read here",
                    "Export without compression");
}

std::uint64_t mode_of(const JsonValue& primitive) {
  const std::uint64_t mode = primitive.whole("mode", 4);
  if (mode > 6) primitive.fail(fmt::format("the mode {} is not known", mode));
  return mode;
}

bool has_positions(const JsonValue& primitive) {
  return primitive.require("attributes").find("POSITION").has_value();
}

}  // namespace

bool has_triangles(const JsonValue& primitive) {
  return mode_of(primitive) >= 4 && has_positions(primitive);
}

bool has_lines(const JsonValue& primitive) {
  return mode_of(primitive) == 1 && has_positions(primitive);
}

void check_gltf_size(const GltfDocument& document, const std::vector<GltfInstance>& instances) {
  const auto count = [&](const JsonValue& accessor) {
    return document.root.item("accessors", accessor.whole()).require("count").whole();
  };
  std::uint64_t total = 0;
  for (const GltfInstance& instance : instances) {
    for (const JsonValue& primitive : instance.mesh.items("primitives")) {
      if (!has_triangles(primitive) && !has_lines(primitive)) continue;
      total += count(primitive.require("attributes").require("POSITION"));
      if (const auto indices = primitive.find("indices")) total += count(*indices);
      if (total > max_gltf_size) {
        instance.node.fail("the scene has too many triangles, copies included",
                           "Simplify the scene");
      }
    }
  }
}

std::vector<Vec3> gltf_points(GltfDocument& document, const JsonValue& primitive,
                              const AffineMap& to_scene) {
  refuse_compressed(document, primitive);
  const JsonValue position = primitive.require("attributes").require("POSITION");
  std::vector<Vec3> points = document.accessors.positions(position.whole());
  for (Vec3& p : points) p = document.upright(to_scene(p));
  return points;
}

void append_triangles(GltfDocument& document, const JsonValue& primitive, const AffineMap& to_scene,
                      TriangleMesh& mesh) {
  const std::vector<Vec3> points = gltf_points(document, primitive, to_scene);
  std::vector<Triangle> triangles = assemble(
      primitive.whole("mode", 4), corners_of(document, primitive, points.size()), primitive);
  const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
  mesh.vertices_nm.insert(mesh.vertices_nm.end(), points.begin(), points.end());
  const bool flip = to_scene.mirrors();
  for (Triangle& t : triangles) {
    if (flip) std::swap(t[1], t[2]);
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

std::vector<GltfBody> gltf_bodies(const GltfDocument& document,
                                  const std::vector<GltfInstance>& instances) {
  constexpr std::uint64_t no_material = ~std::uint64_t{0};
  std::vector<GltfBody> bodies;
  for (const GltfInstance& instance : instances) {
    std::string name = instance.node.text("name", "");
    if (name.empty()) name = instance.mesh.text("name", "");
    std::vector<std::pair<std::uint64_t, std::size_t>> targets;  // material, place in bodies
    for (const JsonValue& primitive : instance.mesh.items("primitives")) {
      if (!has_triangles(primitive)) continue;
      const std::uint64_t material = primitive.whole("material", no_material);
      auto target = std::find_if(targets.begin(), targets.end(),
                                 [&](const auto& entry) { return entry.first == material; });
      if (target == targets.end()) {
        targets.emplace_back(material, bodies.size());
        const std::string material_name =
            material == no_material ? ""
                                    : document.root.item("materials", material).text("name", "");
        bodies.push_back({name, material_name, &instance, {}});
        target = targets.end() - 1;
      }
      bodies[target->second].primitives.push_back(primitive);
    }
  }
  return bodies;
}

}  // namespace surf::io
