// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/core/parameters.h"
#include "surf/io/mesh_unit.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/simplify_mesh.h"

namespace surf::cli {

/// What `semsurf mesh` makes of its inputs.
struct MeshParameters {
  double scale = 1;
  bool repair = false;
  RepairOptions mending;  ///< what a repair does
  std::optional<int> smooth;
  SimplifyOptions reduce;
  bool solid = false;
  std::optional<double> thickness_nm;
  bool plain = false;
  std::optional<double> out_unit_nm;
  std::optional<double> magnification;
  bool true_size = false;
  std::optional<double> z_exaggeration;
};

void describe(ParameterVisitor& visit, MeshParameters& parameters);

/// The fields of a SpecimenRequest that say how surfaces are read, of meshes and of heights.
inline const std::vector<std::string> surface_readings{"specimen.unit", "specimen.override_unit",
                                                       "scan.height_unit", "scan.height_pitch"};

/// The unit of mesh files. Throws UsageError where one overrides that is not given.
io::MeshUnit mesh_unit_of(const io::SpecimenRequest& request);

}  // namespace surf::cli
