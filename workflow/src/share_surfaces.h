// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "surf/mc/geometry/scene_surfaces.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// Surfaces that the processes of a machine have once, in memory that they share: the first process
/// makes them, the others' `make` is not called. Where it fails, all fail.
mc::SceneSurfaces share_surfaces(NodeMemory& node, const std::function<mc::SceneSurfaces()>& make);

}  // namespace surf::workflow
