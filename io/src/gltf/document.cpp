// SPDX-License-Identifier: GPL-3.0-or-later
// Section numbers are those of the glTF 2.0 specification (Khronos Group, ISO/IEC 12113:2022).
#include "document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "files/damaged.h"
#include "files/text_scanner.h"
#include "names.h"
#include "surf/core/error.h"

namespace surf::io {

bool is_glb(std::string_view content) { return content.starts_with("glTF"); }
namespace {

std::uint32_t little_endian_32(std::string_view content, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(content[offset + i])} << (8 * i);
  }
  return value;
}

using Container = GltfDocument::Container;

/// 4.4: a header of 12 bytes, then chunks of a length, a type and their bytes.
Container open_glb(const std::string& file, std::string_view content) {
  const auto cut_off = [&](const std::string& reason) -> FileError {
    return {file, reason, copy_again};
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
      "KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
      "KHR_lights_",    "EXT_lights_",  "KHR_xmp"};
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
    throw Unsupported(
        root.place(),
        fmt::format("it requires the extension {}, which cannot be read here", shown(extension)),
        compresses ? "Export without compression" : "Export without it");
  }
}

constexpr double metre_nm = 1e9;

double positive(const JsonValue& own, const char* key) {
  const JsonValue value = own.require(key);
  const double number = value.number();
  if (!(number > 0)) value.fail("a number above 0 is expected");
  return number;
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& path, std::string_view content)
    : GltfDocument(path, open(path.string(), content)) {}

GltfDocument::GltfDocument(const std::filesystem::path& path, const Container& container)
    : root(JsonValue::parse(path.string(), container.json)),
      accessors(path, root, container.binary), unit_nm(metre_nm) {
  check_version(root);
  check_extensions(root);
  const auto extras = root.require("asset").find("extras");
  if (extras && extras->is_object()) own_ = extras->find(gltf_own_key);
  if (!own_) return;
  unit_nm = metre_nm / positive(*own_, gltf_magnification_key);
  z_exaggeration = positive(*own_, gltf_exaggeration_key);
}

std::map<std::string, std::string> GltfDocument::metadata() const {
  return own_ ? own_->texts(gltf_metadata_key) : std::map<std::string, std::string>{};
}

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

}  // namespace surf::io
