// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

#include "mesh/letter_f_mesh.h"

namespace surf::test {

enum GltfType {
  gltf_int8 = 5120,
  gltf_uint8,
  gltf_int16,
  gltf_uint16,
  gltf_uint32 = 5125,
  gltf_float32
};

/// Builds a glTF file piece by piece: `json` may be changed at will before it is packed.
class GltfWriter {
 public:
  nlohmann::json json{{"asset", {{"version", "2.0"}}}};
  std::string binary;

  /// A view over the bytes, at a multiple of 4 as GLB wants it; its index.
  int add_view(const std::string& content, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    nlohmann::json view{
        {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", content.size()}};
    if (stride > 0) view["byteStride"] = stride;
    binary += content;
    return push("bufferViews", view);
  }

  int add_accessor(int view, GltfType type, std::size_t count, const char* shape) {
    return push("accessors",
                {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
  }

  /// y up, as glTF has it: the reader turns it back.
  int add_positions(const std::vector<Vec3>& points) {
    std::string content;
    for (const Vec3& p : points) {
      for (const double c : {p.x, p.z, -p.y}) content += bytes(static_cast<float>(c), false);
    }
    return add_accessor(add_view(content), gltf_float32, points.size(), "VEC3");
  }

  int add_indices(const std::vector<std::uint32_t>& indices, GltfType type = gltf_uint32) {
    return add_accessor(add_view(packed(indices, type)), type, indices.size(), "SCALAR");
  }

  static std::string packed(const std::vector<std::uint32_t>& indices, GltfType type) {
    std::string content;
    for (const std::uint32_t i : indices) {
      content += bytes(i, false).substr(0, type == gltf_uint8 ? 1 : type == gltf_uint16 ? 2 : 4);
    }
    return content;
  }

  /// A mesh of one primitive; its index.
  int add_mesh(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const int positions = add_positions(mesh.vertices_nm);  // accessor 0 of the letter's file
    return add_mesh(positions, add_indices(corners));
  }
  int add_mesh(int positions, int indices) {
    nlohmann::json primitive{{"attributes", {{"POSITION", positions}}}};
    if (indices >= 0) primitive["indices"] = indices;
    return push("meshes", {{"primitives", nlohmann::json::array({primitive})}});
  }

  int add_node(const nlohmann::json& node) { return push("nodes", node); }

  std::string glb() const {
    nlohmann::json packed_json = json;
    if (!binary.empty()) packed_json["buffers"] = {{{"byteLength", binary.size()}}};
    return container(packed_json.dump(), binary);
  }

  /// With the data in a URI: base64 or the name of a file.
  std::string text(const std::string& uri) const {
    nlohmann::json packed_json = json;
    packed_json["buffers"] = {{{"byteLength", binary.size()}, {"uri", uri}}};
    return packed_json.dump();
  }

  static std::string container(std::string json_text, std::string chunk) {
    json_text.resize((json_text.size() + 3) / 4 * 4, ' ');
    chunk.resize((chunk.size() + 3) / 4 * 4);
    const auto number = [](std::size_t n) { return bytes(static_cast<std::uint32_t>(n), false); };
    std::string content = number(json_text.size()) + "JSON" + json_text;
    if (!chunk.empty()) content += number(chunk.size()) + std::string("BIN\0", 4) + chunk;
    return "glTF" + number(2) + number(12 + content.size()) + content;
  }

  static std::string base64(const std::string& content) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < content.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        bits =
            bits << 8 | (i + j < content.size() ? static_cast<unsigned char>(content[i + j]) : 0u);
      }
      for (std::size_t j = 0; j < 4; ++j) {
        text += i + j <= content.size() ? digits[bits >> (18 - 6 * j) & 63] : '=';
      }
    }
    return text;
  }

 private:
  int push(const char* key, const nlohmann::json& value) {
    json[key].push_back(value);
    return static_cast<int>(json[key].size()) - 1;
  }
};

/// One node that shows the letter F.
inline GltfWriter gltf_of_f() {
  GltfWriter gltf;
  gltf.add_node({{"mesh", gltf.add_mesh(letter_f_triangles())}, {"name", "F"}});
  return gltf;
}

}  // namespace surf::test
