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

/// Which files make a specimen, and what they do not say themselves: one scene file, or meshes and
/// at most one height field.
struct SpecimenRequest {
  std::vector<std::string> inputs;
  std::optional<std::string> material;      ///< absent: Si, which is noted
  std::vector<std::string> material_files;  ///< materials of the user's own, TOML
  std::optional<double> mesh_unit_nm;       ///< > 0; see MeshUnit
  bool override_unit = false;
  std::optional<std::string> substrate;  ///< a material; absent: none, or the scene file's
  std::optional<double> substrate_z_nm;  ///< absent: 0, or the scene file's
  std::optional<Edge> edge;              ///< absent: mirror, or the scene file's
  HeightReadOptions heights;  ///< how a height field is read; its pitch is in place of the file's
};

void describe(ParameterVisitor& visit, SpecimenRequest& request);

/// Reads it all: the scene file with what is said here in place of what it says, or a scene of
/// default settings. What had to be assumed is in the scene's notes. Meshes are read by `read`.
/// Throws UsageError, FileError, InvalidInput.
SceneFile read_specimen(const SpecimenRequest& request, const BodyReader& read = read_mesh_bodies);

}  // namespace surf::io
