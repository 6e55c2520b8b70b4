// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "files/json_value.h"
#include "surf/core/vec3.h"

namespace surf::io {

/// The path of the file that a buffer's URI names, beside `path`. `buffer` is the place for
/// messages.
std::filesystem::path gltf_buffer_file(const std::filesystem::path& path, const JsonValue& buffer,
                                       const std::string& uri);
inline bool is_data_uri(const std::string& uri) { return uri.starts_with("data:"); }

/// Reads the numbers of a glTF file: its accessors, over views of buffers that lie in the file
/// itself, in data URIs or in files beside it. Buffers are loaded on first use.
class GltfAccessors {
 public:
  /// `binary` is the GLB's second chunk, or empty. `root` and `binary` must outlive this object.
  GltfAccessors(std::filesystem::path path, const JsonValue& root, std::string_view binary)
      : path_(std::move(path)), root_(root), binary_(binary) {}

  /// Three finite coordinates per vertex, of any component type. Normalized ones are divided as
  /// KHR_mesh_quantization demands.
  std::vector<Vec3> positions(std::uint64_t accessor);
  /// One unsigned whole number per element.
  std::vector<std::uint32_t> indices(std::uint64_t accessor);
  /// One finite number per element, of any component type, as float32.
  std::vector<float> scalars(std::uint64_t accessor);
  /// Whether an accessor's values are single numbers.
  bool is_scalar(std::uint64_t accessor) const;
  /// The bytes of an image in the file, in a data URI or in a file beside it.
  std::string image(const JsonValue& image);

 private:
  struct Layout;  // how an accessor's values are stored in bytes
  struct View;    // a range of bytes

  std::string_view buffer(std::uint64_t index);
  std::string load(const JsonValue& buffer, const std::string& uri, std::uint64_t bytes) const;
  View view(const JsonValue& owner);
  Layout layout(const JsonValue& accessor) const;
  std::vector<double> values(const JsonValue& accessor);
  void apply_sparse(const JsonValue& sparse, const Layout& base, std::vector<double>& values);
  std::vector<double> decode(const JsonValue& owner, const Layout& layout);

  std::filesystem::path path_;
  const JsonValue& root_;
  std::string_view binary_;
  std::map<std::uint64_t, std::string> loaded_;
};

}  // namespace surf::io
