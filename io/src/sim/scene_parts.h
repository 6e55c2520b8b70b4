// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "sim/toml_table.h"
#include "surf/core/error.h"
#include "surf/io/sim/scene_file.h"

namespace surf::io {

/// The solids of a scene file: its substrate, height field and bodies.
class SceneParts {
 public:
  /// Adds materials to `scene.specimen` and files to `scene.inputs`. `scene` must outlive this
  /// object.
  SceneParts(std::filesystem::path folder, SceneFile& scene, BodyReader read)
      : folder_(std::move(folder)), scene_(scene), read_(std::move(read)) {}

  mc::Substrate read_substrate(const TomlTable& table);
  mc::HeightFieldBody read_height_field(const TomlTable& table);
  /// Returns one body for a shape, one or more for a mesh file.
  std::vector<mc::Body> read_bodies(const TomlTable& table);

 private:
  int material(const TomlTable& table);
  /// Returns a path in the scene, relative to its folder, and notes it as an input.
  std::filesystem::path input(const TomlTable& table, std::string_view key);
  HeightField read_field_file(const TomlTable& table);
  std::vector<mc::Body> read_mesh_file(const TomlTable& table);

  std::filesystem::path folder_;
  SceneFile& scene_;
  BodyReader read_;
};

/// Rewrites fields in `text` as a scene file writes them: beam.tilt, beam.tilt = 30deg.
std::string with_scene_words(std::string_view text);

/// Throws the error with its place in the scene file: the field's own key if the table has it, else
/// `key`.
[[noreturn]] void refuse_at(const TomlTable& table, std::string_view key, const UsageError& error);

/// Runs `work`. An error is reported at its place in the scene file.
template <class Work>
auto at_place(const TomlTable& table, std::string_view key, const Work& work) {
  try {
    return work();
  } catch (const UsageError& error) {
    refuse_at(table, key, error);
  }
}

}  // namespace surf::io
