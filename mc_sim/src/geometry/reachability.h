// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "surf/core/progress.h"
#include "surf/core/vec3.h"
#include "surf/mc/geometry/scene_surfaces.h"
#include "surf/mesh/mesh_view.h"

namespace surf::mc {

/// For every triangle 1 where an electron from outside may come within `reach_nm` (>= 0) of it,
/// else 0. The answer errs towards 1: space is cut into boxes, and one counts as matter only where
/// no triangle touches it and its middle is within a solid, or where all of it is below `plane_nm`.
/// What is not matter and hangs together with the rim of `domain` may be vacuum open to the
/// outside. Triangles that reach beyond `domain` are always 1. Throws Interrupted.
std::vector<std::uint8_t> reachable_triangles(const MeshView& mesh,
                                              std::span<const std::uint32_t> shell_of,
                                              const std::vector<Shell>& shells,
                                              std::optional<double> plane_nm, const Box& domain,
                                              double reach_nm, const Watch& watch = {});

}  // namespace surf::mc
