// SPDX-License-Identifier: GPL-3.0-or-later
// Section numbers are those of the glTF 2.0 specification.
#include "gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace surf::io
