// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/mc/geometry/specimen.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// Facts about the specimen's shapes that a job needs besides the scene.
struct SpecimenFacts {
  Box extent;                         ///< result of mc::extent
  std::vector<mc::BodyFacts> bodies;  ///< result of mc::validate
};

/// Validates the specimen. With several processes on a machine the first one does it for all.
SpecimenFacts facts_of(const mc::Specimen& specimen, NodeMemory* node, const Watch& watch);

}  // namespace surf::workflow
