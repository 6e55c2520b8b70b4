// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "surf/core/parameters.h"
#include "surf/io/mesh_unit.h"
#include "surf/io/sim/specimen_request.h"
#include "surf/mesh/repair_mesh.h"

namespace surf::cli {

/// What `semsurf mesh` makes of its inputs.
struct MeshParameters {
  double scale = 1;
  bool repair = false;
  std::optional<double> stitch_nm;
  double sliver_nm = RepairOptions{}.sliver_nm;
  std::optional<double> max_hole_nm;
  double min_component_nm = RepairOptions{}.min_component_nm;
  bool keep_intersections = false;
  std::optional<int> smooth;
  std::optional<double> mesh_tolerance_nm;
  std::optional<std::int64_t> triangles;
  bool solid = false;
  std::optional<double> thickness_nm;
  bool plain = false;
  std::optional<double> out_unit_nm;
  std::optional<double> magnification;
  bool true_size = false;
  std::optional<double> z_exaggeration;
};

void describe(ParameterVisitor& visit, MeshParameters& parameters);

/// The unit of mesh files. Throws UsageError where one overrides that is not given.
io::MeshUnit mesh_unit_of(const io::SpecimenRequest& request);

}  // namespace surf::cli
