// SPDX-License-Identifier: GPL-3.0-or-later
// Steps before a simulation begins, used by simulations and dry runs.
#pragma once

#include "resolved_job.h"
#include "specimen_facts.h"
#include "surf/mc/geometry/scene.h"

namespace surf::workflow {

/// Completes the job with the options of the simulator. Throws UsageError for numbers out of range.
ResolvedJob resolve(SimulateJob job);

/// An image of one pixel with the channels of the result.
Image image_like_the_result(const ResolvedJob& job);

/// Checks that everything can be written. The job must be complete. Throws UsageError, FileError.
void check_outputs(const ResolvedJob& job);
void check_checkpoint(const ResolvedJob& job);

/// Makes the scene from the specimen, or from a simplified specimen within the requested tolerance.
/// `summary` has the scan, and receives the simplification. With a `node` its processes share the
/// triangles of the first process.
mc::Scene make_scene(const ResolvedJob& job, const SpecimenFacts& facts, NodeMemory* node,
                     const NoteCallback& tell, const CancelToken* cancel, SimulateSummary& summary);

}  // namespace surf::workflow
