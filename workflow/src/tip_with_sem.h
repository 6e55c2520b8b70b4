// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/register_job.h"

namespace surf::workflow {

/// Replaces a tip that was found blindly by the one with which the eroded scan explains the SEM
/// image best, if there is one, and registers the images again with that. Returns whether it was
/// replaced.
bool find_tip_with_sem(PreparedAfm& afm, Pose& pose, const PoseOptions& options,
                       const PlacedImage& sem, const StoredModel& model, int threads,
                       const Reporter& reporter);

}  // namespace surf::workflow
