// SPDX-License-Identifier: GPL-3.0-or-later
// Section numbers are those of the glTF 2.0 specification (Khronos Group, ISO/IEC 12113:2022).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "gltf_accessors.h"
#include "gltf_nodes.h"
#include "mesh_formats.h"
#include "surf/core/error.h"
#include "text_scanner.h"

namespace surf::io {
namespace {

/// Vertices and indices in a scene, copies included.
constexpr std::uint64_t max_gltf_size = std::uint64_t{1} << 28;

std::uint32_t little_endian_32(std::string_view content, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(content[offset + i])} << (8 * i);
  }
  return value;
}

struct Container {
  std::string_view json;
  std::string_view binary;
};

/// 4.4: a header of 12 bytes, then chunks of a length, a type and their bytes.
Container open_glb(const std::string& file, std::string_view content) {
  const auto cut_off = [&](const std::string& reason) -> FileError {
    return {file, reason, "It is cut off or damaged: copy or export it again"};
  };
  if (content.size() < 20) throw cut_off("it ends within its header");
  if (const std::uint32_t version = little_endian_32(content, 4); version != 2) {
    throw Unsupported(file, fmt::format("this is version {} of GLB", version), "Export glTF 2.0");
  }
  const std::uint32_t announced = little_endian_32(content, 8);
  if (announced > content.size()) {
    throw cut_off(fmt::format("the header announces {} bytes, but the file has {}", announced,
                              content.size()));
  }
  Container container;
  std::size_t position = 12;
  for (int chunk = 0; chunk < 2 && content.size() - position >= 8; ++chunk) {
    const std::uint32_t bytes = little_endian_32(content, position);
    const std::string_view type = content.substr(position + 4, 4);
    position += 8;
    if (bytes > content.size() - position) {
      throw cut_off(fmt::format("chunk {} of {} bytes goes beyond the end", chunk, bytes));
    }
    const std::string_view data = content.substr(position, bytes);
    position += bytes;
    if (chunk == 0) {
      if (type != "JSON") throw cut_off("its first chunk is not JSON");
      container.json = data;
    } else if (type == std::string_view("BIN\0", 4)) {
      container.binary = data;
    }
  }
  return container;
}

Container open(const std::string& file, std::string_view content) {
  return is_glb(content) ? open_glb(file, content) : Container{content, {}};
}

/// Extensions that change nothing about shapes.
bool is_harmless(const std::string& extension) {
  static constexpr std::array<std::string_view, 7> beginnings{
      "KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
      "EXT_lights_", "KHR_xmp"};
  return extension == "KHR_mesh_quantization" ||
         std::any_of(beginnings.begin(), beginnings.end(),
                     [&](std::string_view b) { return extension.starts_with(b); });
}

void check_version(const JsonValue& root) {
  const std::string version = root.require("asset").require("version").text();
  if (version.starts_with("2.")) return;
  throw Unsupported(root.place(), fmt::format("this is glTF version '{}'", shown(version)),
                    "Export glTF 2.0");
}

void check_extensions(const JsonValue& root) {
  for (const JsonValue& item : root.items("extensionsRequired")) {
    const std::string extension = item.text();
    if (is_harmless(extension)) continue;
    const bool compresses = extension == "KHR_draco_mesh_compression" ||
                            extension == "EXT_meshopt_compression" ||
                            extension == "KHR_meshopt_compression";
    throw Unsupported(root.place(),
                      fmt::format("it requires the extension {}, which cannot be read here",
                                  shown(extension)),
                      compresses ? "Export without compression" : "Export without it");
  }
}

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

class GltfParser {
 public:
  GltfParser(const std::filesystem::path& path, const JsonValue& root, std::string_view binary)
      : root_(root), accessors_(path, root, binary) {}

  std::vector<NamedMesh> parse() {
    const std::vector<GltfInstance> instances = gltf_instances(root_);
    check_size(instances);
    for (const GltfInstance& instance : instances) add(instance);
    return std::move(meshes_);
  }

 private:
  /// Many nodes can show one mesh: this stops a small file from filling the memory.
  void check_size(const std::vector<GltfInstance>& instances) const {
    std::uint64_t total = 0;
    for (const GltfInstance& instance : instances) {
      for (const JsonValue& primitive : instance.mesh.items("primitives")) {
        if (!has_triangles(primitive)) continue;
        total += count(primitive.require("attributes").require("POSITION"));
        if (const auto indices = primitive.find("indices")) total += count(*indices);
        if (total > max_gltf_size) {
          instance.node.fail("the scene has too many triangles, copies included",
                             "Simplify the scene");
        }
      }
    }
  }

  std::uint64_t count(const JsonValue& accessor_index) const {
    return root_.item("accessors", accessor_index.whole()).require("count").whole();
  }

  /// One mesh per material, in the order of their first primitive.
  void add(const GltfInstance& instance) {
    std::string name = instance.node.text("name", "");
    if (name.empty()) name = instance.mesh.text("name", "");
    std::vector<std::pair<std::uint64_t, std::size_t>> targets;   // material, place in meshes_
    for (const JsonValue& primitive : instance.mesh.items("primitives")) {
      if (!has_triangles(primitive)) continue;
      const std::uint64_t material = primitive.whole("material", no_material);
      auto target = std::find_if(targets.begin(), targets.end(),
                                 [&](const auto& entry) { return entry.first == material; });
      if (target == targets.end()) {
        targets.emplace_back(material, meshes_.size());
        meshes_.push_back({name, material_name(material), {}});
        target = targets.end() - 1;
      }
      add(primitive, instance.to_scene, meshes_[target->second].mesh);
    }
  }

  static bool has_triangles(const JsonValue& primitive) {
    const std::uint64_t mode = primitive.whole("mode", 4);
    if (mode > 6) primitive.fail(fmt::format("the mode {} is not known", mode));
    return mode >= 4 && primitive.require("attributes").find("POSITION").has_value();
  }

  std::string material_name(std::uint64_t index) const {
    return index == no_material ? std::string{} : root_.item("materials", index).text("name", "");
  }

  void add(const JsonValue& primitive, const AffineMap& to_scene, TriangleMesh& mesh) {
    refuse_compressed(primitive);
    const JsonValue position = primitive.require("attributes").require("POSITION");
    const std::vector<Vec3> points = accessors_.positions(position.whole());
    std::vector<Triangle> triangles =
        assemble(primitive.whole("mode", 4), corners(primitive, points.size()), primitive);
    const auto first = static_cast<std::uint32_t>(mesh.vertices_nm.size());
    for (const Vec3& p : points) {
      const Vec3 q = to_scene(p);
      mesh.vertices_nm.push_back({q.x, 0.0 - q.z, q.y});   // y up becomes z up
    }
    const bool flip = to_scene.mirrors();
    for (Triangle& t : triangles) {
      if (flip) std::swap(t[1], t[2]);
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }

  std::vector<std::uint32_t> corners(const JsonValue& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> corners;
    const auto indices = primitive.find("indices");
    if (indices) {
      corners = accessors_.indices(indices->whole());
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
  void refuse_compressed(const JsonValue& primitive) const {
    const auto extensions = primitive.find("extensions");
    if (!extensions || !extensions->find("KHR_draco_mesh_compression")) return;
    const auto position = primitive.require("attributes").require("POSITION").whole();
    if (root_.item("accessors", position).find("bufferView")) return;
    throw Unsupported(primitive.place(), "it is compressed with Draco, which cannot be read here",
                      "Export without compression");
  }

  static constexpr std::uint64_t no_material = ~std::uint64_t{0};

  const JsonValue& root_;
  GltfAccessors accessors_;
  std::vector<NamedMesh> meshes_;
};

}  // namespace

bool is_glb(std::string_view content) { return content.starts_with("glTF"); }

std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& path,
                                                     std::string_view content) {
  const JsonValue root = JsonValue::parse(path.string(), open(path.string(), content).json);
  std::vector<std::filesystem::path> files;
  for (const JsonValue& buffer : root.items("buffers")) {
    const std::string uri = buffer.text("uri", "");
    if (!uri.empty() && !is_data_uri(uri)) files.push_back(gltf_buffer_file(path, buffer, uri));
  }
  return files;
}

std::vector<NamedMesh> parse_gltf(const std::filesystem::path& path, std::string_view content) {
  const std::string file = path.string();
  const Container container = open(file, content);
  const JsonValue root = JsonValue::parse(file, container.json);
  check_version(root);
  check_extensions(root);
  return GltfParser(path, root, container.binary).parse();
}

}  // namespace surf::io
