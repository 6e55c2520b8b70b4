// SPDX-License-Identifier: GPL-3.0-or-later
// Section numbers are those of the glTF 2.0 specification (Khronos Group, ISO/IEC 12113:2022).
#include "shown_meshes.h"

#include <cmath>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mesh/parsed_file.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

template <std::size_t N>
std::array<double, N> numbers(const JsonValue& node, const std::string& key,
                              std::array<double, N> fallback) {
  if (!node.find(key)) return fallback;
  const std::vector<JsonValue> items = node.items(key);
  if (items.size() != N) {
    node.require(key).fail(fmt::format("{} numbers belong here, not {}", N, items.size()));
  }
  std::array<double, N> values;
  std::transform(items.begin(), items.end(), values.begin(),
                 [](const JsonValue& item) { return item.number(); });
  return values;
}

/// The columns of the rotation that a quaternion (x, y, z, w) means, of any length but 0.
std::array<Vec3, 3> rotation(const JsonValue& node) {
  auto [x, y, z, w] = numbers<4>(node, "rotation", {0, 0, 0, 1});
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(size > 0) || !std::isfinite(size)) {
    node.require("rotation").fail("no rotation has this quaternion");
  }
  x /= size, y /= size, z /= size, w /= size;
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          Vec3{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          Vec3{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

/// 3.5.3: a matrix by columns, or scale, then rotation, then translation.
AffineMap local_map(const JsonValue& node) {
  if (node.find("matrix")) {
    const auto m = numbers<16>(node, "matrix", {});
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
      node.require("matrix").fail("its last row is not 0 0 0 1");
    }
    return {{Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]},
             Vec3{m[12], m[13], m[14]}}};
  }
  const auto scale = numbers<3>(node, "scale", {1, 1, 1});
  const auto shift = numbers<3>(node, "translation", {0, 0, 0});
  const auto turned = rotation(node);
  return {{turned[0] * scale[0], turned[1] * scale[1], turned[2] * scale[2],
           Vec3{shift[0], shift[1], shift[2]}}};
}

std::vector<std::uint64_t> node_list(const JsonValue& owner, const std::string& key) {
  std::vector<std::uint64_t> nodes;
  for (const JsonValue& item : owner.items(key)) nodes.push_back(item.whole());
  return nodes;
}

std::vector<std::uint64_t> nodes_without_parent(const JsonValue& root) {
  std::vector<bool> has_parent(root.count("nodes"), false);
  for (const JsonValue& node : root.items("nodes")) {
    for (const std::uint64_t child : node_list(node, "children")) {
      if (child < has_parent.size()) has_parent[child] = true;
    }
  }
  std::vector<std::uint64_t> nodes;
  for (std::size_t i = 0; i < has_parent.size(); ++i) {
    if (!has_parent[i]) nodes.push_back(i);
  }
  return nodes;
}

std::vector<std::uint64_t> scene_roots(const JsonValue& root) {
  if (root.count("scenes") == 0) return nodes_without_parent(root);
  return node_list(root.item("scenes", root.whole("scene", 0)), "nodes");
}

bool is_deformed(const JsonValue& owner) {
  const std::vector<JsonValue> weights = owner.items("weights");
  return std::any_of(weights.begin(), weights.end(),
                     [](const JsonValue& weight) { return weight.number() != 0; });
}

void refuse_deformed(const JsonValue& node, const JsonValue& mesh) {
  const char* const remedy = "Apply it in the program that made the file, and export again";
  if (node.find("skin")) {
    throw Unsupported(node.place(), "its shape depends on a skeleton, which is not followed here",
                      remedy);
  }
  if (node.find("weights") ? is_deformed(node) : is_deformed(mesh)) {
    throw Unsupported(node.place(), "its shape depends on shape keys, which are not followed here",
                      remedy);
  }
}

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

std::vector<GltfInstance> gltf_instances(const JsonValue& root) {
  struct Visit {
    std::uint64_t node;
    AffineMap parent;
  };
  std::vector<GltfInstance> instances;
  std::vector<bool> seen(root.count("nodes"), false);
  std::vector<Visit> waiting;  // the next one is the last
  const auto wait_for = [&waiting](std::vector<std::uint64_t> nodes, const AffineMap& parent) {
    std::reverse(nodes.begin(), nodes.end());
    for (const std::uint64_t node : nodes) waiting.push_back({node, parent});
  };
  wait_for(scene_roots(root), {});
  while (!waiting.empty()) {
    const Visit visit = waiting.back();
    waiting.pop_back();
    const JsonValue node = root.item("nodes", visit.node);
    if (seen[visit.node]) node.fail("it is the child of two nodes, or of itself");
    seen[visit.node] = true;
    const AffineMap map = product(visit.parent, local_map(node));
    if (const auto mesh_index = node.find("mesh")) {
      const JsonValue mesh = root.item("meshes", mesh_index->whole());
      refuse_deformed(node, mesh);
      instances.push_back({node, mesh, map});
    }
    wait_for(node_list(node, "children"), map);
  }
  return instances;
}

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
