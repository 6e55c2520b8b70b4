// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/sim/mesh_bodies.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// Makes a reader of specimen meshes that first checks that they fit into memory
/// (`require_memory`). If several processes of a machine read the same meshes together, the first
/// one reads. The others get the bodies' names and materials, and empty meshes. `each` is the
/// number of processes on this machine that read on their own at the same time.
io::BodyReader specimen_reader(NodeMemory* node = nullptr, int each = 1);

}  // namespace surf::workflow
