// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/sim/mesh_bodies.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// Reads meshes to be simulated: asks first whether they fit into memory (`require_memory`). Where
/// several processes of a machine read the same ones together, the first one reads; the others get
/// the bodies' names and materials, and empty meshes. `each`: so many processes of this machine
/// read on their own at the same time.
io::BodyReader specimen_reader(NodeMemory* node = nullptr, int each = 1);

}  // namespace surf::workflow
