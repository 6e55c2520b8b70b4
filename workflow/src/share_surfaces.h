// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "surf/mc/geometry/scene_surfaces.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// Surfaces in memory shared by the processes of a machine. The first process makes them; the
/// `make` of the others is not called. If it fails, it fails on all.
mc::SceneSurfaces share_surfaces(NodeMemory& node, const std::function<mc::SceneSurfaces()>& make);

}  // namespace surf::workflow
