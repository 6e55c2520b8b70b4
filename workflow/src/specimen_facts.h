// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/mc/geometry/specimen.h"
#include "surf/workflow/node_memory.h"

namespace surf::workflow {

/// What a job has to know of its specimen's shapes besides tracing them.
struct SpecimenFacts {
  Box extent;                         ///< mc::extent
  std::vector<mc::BodyFacts> bodies;  ///< mc::validate
};

/// Validates the specimen; on a machine of several processes the first one does, for all.
SpecimenFacts facts_of(const mc::Specimen& specimen, NodeMemory* node, const Watch& watch);

}  // namespace surf::workflow
