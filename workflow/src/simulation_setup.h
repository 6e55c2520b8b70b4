// SPDX-License-Identifier: GPL-3.0-or-later
// What happens before a simulation begins, for whoever simulates or only says what it would take.
#pragma once

#include "resolved_job.h"
#include "specimen_facts.h"
#include "surf/mc/geometry/scene.h"

namespace surf::workflow {

/// The job with everything that the simulator has to know. Throws UsageError for numbers out of
/// range.
ResolvedJob resolve(SimulateJob job);

/// An image of one pixel with the channels of the result.
Image image_like_the_result(const ResolvedJob& job);

/// Whether everything can be written, of a complete job. Throws UsageError, FileError.
void check_outputs(const ResolvedJob& job);
void check_checkpoint(const ResolvedJob& job);

/// What is traced: the specimen, or one of fewer triangles within the tolerance asked for.
/// `summary` has the scan, and gets what was left out. With a `node` its processes share the
/// triangles of the first one's specimen.
mc::Scene make_scene(const ResolvedJob& job, const SpecimenFacts& facts, NodeMemory* node,
                     const NoteCallback& tell, const CancelToken* cancel, SimulateSummary& summary);

}  // namespace surf::workflow
