// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "surf/core/height_field.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/specimen_request.h"

namespace surf::io {

/// Shapes of a specimen that no file holds.
struct ShapesInMemory {
  std::vector<NamedMesh> meshes;  ///< those without a material are of the request's
  std::optional<HeightField> field;
};

/// As `read_specimen` (specimen_request.h) of the request's files, with these shapes besides. A
/// request that names a scene file can have none.
SceneFile read_specimen(const SpecimenRequest& request, const ShapesInMemory& shapes,
                        const BodyReader& read = read_mesh_bodies);

}  // namespace surf::io
