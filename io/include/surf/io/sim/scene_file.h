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

/// A request and where it came from: a scene file, or a command line that names meshes.
struct SceneFile : mc::SimulationRequest {
  bool unit_assumed = false;  ///< of a mesh: neither its file nor the user said the unit
  MaterialLibrary materials;  ///< built-in ones, the scene's own, those of files
  /// Mesh files whose own unit does not count, by name, and the nm of the unit that does.
  std::vector<std::pair<std::string, double>> unit_overrides;
  std::vector<std::filesystem::path> inputs;  ///< files read: the scene itself, then the others
  std::vector<std::string> notes;             ///< what the user may want to know
};

/// Reads a scene in TOML. Paths in it are relative to the scene file. Unknown keys are errors, with
/// the nearest known key suggested. Throws FileError with line and column, UsageError for values.
/// Lengths, energies and angles are numbers (nm, eV, degrees) or texts with a unit; several lengths
/// are an array or a text with commas. The tables [beam], [scan] and [simulation] hold the
/// parameters of `mc::SimulationRequest`, as `describe` names them; docs/reference/scene_files.md
/// lists all keys.
///
/// `material_files` are read as well; what they say goes before the scene's own materials. `read`
/// reads the mesh files.
SceneFile read_scene(const std::filesystem::path& path,
                     const std::vector<std::filesystem::path>& material_files = {},
                     const BodyReader& read = read_mesh_bodies);

/// The scene and the files that it names, with those that are read with them (`files_read_with`);
/// nothing but the scene is read whole. Throws what `read_scene` would for a file that is no TOML.
std::vector<std::filesystem::path> scene_input_files(const std::filesystem::path& path);

/// Whether the name ends in ".toml".
bool is_scene_file(const std::filesystem::path& path);

}  // namespace surf::io
