// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "surf/io/sim/materials.h"
#include "surf/io/sim/mesh_bodies.h"
#include "surf/mc/request/simulation_request.h"

namespace surf::io {

/// A simulation request and its origin: a scene file, or a command line that names meshes.
struct SceneFile : mc::SimulationRequest {
  bool unit_assumed = false;  ///< the unit of a mesh is stated neither by its file nor by the user
  MaterialLibrary materials;  ///< the built-in ones, the scene's own, those of material files
  /// Mesh files whose stated unit is overridden: the file's name, and the unit in nm that is used
  /// instead.
  std::vector<std::pair<std::string, double>> unit_overrides;
  /// Files that were read: the scene itself, then the others.
  std::vector<std::filesystem::path> inputs;
  std::vector<std::string> notes;  ///< notes for the user
};

/// Reads a scene in TOML. Paths in it are relative to the scene file. Unknown keys are errors, with
/// the nearest known key suggested. Throws FileError with line and column, UsageError for wrong
/// values. Lengths, energies and angles are numbers (nm, eV, degrees) or texts with a unit; several
/// lengths are an array or a text with commas. The tables [beam], [scan] and [simulation] hold the
/// parameters of `mc::SimulationRequest`, as `describe` names them; docs/reference/scene_files.md
/// lists all keys.
///
/// `material_files` are read as well; their materials override the scene's own. `read` reads the
/// mesh files.
SceneFile read_scene(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& material_files = {},
                     const BodyReader& read = read_mesh_bodies);

/// Lists the scene and the files that it names, with those that are read with them
/// (`files_read_with`). Only the scene itself is read in full. Throws what `read_scene` would throw
/// for a file that is not TOML.
std::vector<std::filesystem::path> scene_input_files(const std::filesystem::path& path);

/// Whether the name ends in ".toml".
bool is_scene_file(const std::filesystem::path& path);

}  // namespace surf::io
