// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/io/mesh_unit.h"
#include "surf/mesh/repair_mesh.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/smooth_mesh.h"
#include "surf/mesh/surface.h"
#include "surf/workflow/picture_input.h"

namespace surf::cli {

/// What `semsurf mesh` does to each of its inputs.
struct MeshWork {
  io::MeshUnit unit;
  std::optional<double> z_unit_nm;  ///< of scans that do not say
  workflow::GivenPitch pitch;
  double scale = 1;
  std::optional<RepairOptions> repair;
  SmoothOptions smooth;            ///< 0 times: not at all
  SimplifyOptions reduce;          ///< neither limit: not at all
  std::optional<double> solid_nm;  ///< walls and a base so far below the lowest place; 0: chosen
  bool curvature = true;           ///< of a sheet is measured before it gets walls
  bool keep_bodies = true;         ///< false: the bodies of a mesh file become one
  bool quiet = false;

  bool reduces() const { return reduce.tolerance_nm > 0 || reduce.triangles > 0; }
};

/// Adds the surfaces of a mesh file, or of a scan or image of heights, ready to be written, and
/// says on the way what was done. A mesh that is changed loses its scalars. Throws Interrupted, and
/// what reading and treating throw.
void add_mesh_input(const workflow::FileChannel& input, const MeshWork& work, const Watch& watch,
                    SurfaceScene& scene);

}  // namespace surf::cli
