// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/core/edge.h"
#include "surf/io/height_field_file.h"
#include "surf/io/sim/mesh_bodies.h"
#include "surf/io/sim/scene_file.h"

namespace surf {
class ParameterVisitor;
}

namespace surf::io {

/// The files that make a specimen, and the settings that they do not state: one scene file, or
/// meshes and at most one height field.
struct SpecimenRequest {
  std::vector<std::string> inputs;
  std::optional<std::string> material;      ///< absent: Si, and a note says so
  std::vector<std::string> material_files;  ///< the user's own materials, TOML
  std::optional<double> mesh_unit_nm;       ///< > 0; see MeshUnit
  bool override_unit = false;
  std::optional<std::string> substrate;  ///< a material; absent: none, or the scene file's
  std::optional<double> substrate_z_nm;  ///< absent: 0, or the scene file's
  std::optional<Edge> edge;              ///< absent: mirror, or the scene file's
  HeightReadOptions heights;  ///< How a height field is read. This pitch replaces the file's.
};

void describe(ParameterVisitor& visit, SpecimenRequest& request);

/// Reads the whole specimen: the scene file with the settings here in place of its own, or a scene
/// with default settings. Assumptions are listed in the scene's notes. `read` reads the meshes.
/// Throws UsageError, FileError, InvalidInput.
SceneFile read_specimen(const SpecimenRequest& request, const BodyReader& read = read_mesh_bodies);

}  // namespace surf::io
