// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accessors.h"
#include "files/json_value.h"
#include "surf/core/vec3.h"

namespace surf::io {

/// Whether the content is a GLB file.
bool is_glb(std::string_view content);

/// The files beside this one that hold its buffers.
std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& path,
                                                     std::string_view content);

/// An opened glTF or GLB file of version 2 without unreadable extensions, and the scale that
/// semsurf gave it.
class GltfDocument {
 public:
  /// The text and the binary part of a file.
  struct Container {
    std::string_view json;
    std::string_view binary;
  };

  /// `content` must outlive this object. Throws FileError, Unsupported.
  GltfDocument(const std::filesystem::path& path, std::string_view content);
  GltfDocument(const GltfDocument&) = delete;  // the accessors refer to the root

  const JsonValue root;
  GltfAccessors accessors;
  /// Length of one scene unit in nm: a metre, with semsurf's magnification undone.
  double unit_nm;
  /// Factor by which the heights of the scene are exaggerated.
  double z_exaggeration = 1;

  /// Whether the file has semsurf's own extras.
  bool is_own() const { return own_.has_value(); }
  /// Empty in files of other programs.
  std::map<std::string, std::string> metadata() const;

  /// Maps a point from the scene, y up, to z up, with the exaggeration undone.
  Vec3 upright(const Vec3& p) const { return {p.x, 0.0 - p.z, p.y / z_exaggeration}; }

 private:
  GltfDocument(const std::filesystem::path& path, const Container& container);

  std::optional<JsonValue> own_;
};

}  // namespace surf::io
