// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/register_job.h"

namespace surf::workflow {

// The steps that registration and reconstruction share, each a stage of the reporter.

void begin(const Reporter& reporter, const char* stage);

/// With the scan's notes and warnings handed on.
PreparedAfm prepare(const AfmInput& afm, int threads, const Reporter& reporter);

/// Of the SEM image's pixels, which must be square.
StoredModel model_of(ModelRequest request, const PlacedImage& sem, const Reporter& reporter);

Pose pose_of(const PoseOptions& options, const PreparedAfm& afm, const PlacedImage& sem,
             const StoredModel& model, int threads, const Reporter& reporter);

}  // namespace surf::workflow
