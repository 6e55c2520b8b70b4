// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "surf/workflow/register_job.h"

namespace surf::workflow {

// Steps shared by registration and reconstruction. Each is a stage of the reporter.

void begin(const Reporter& reporter, const char* stage);

/// Throws UsageError where results cannot be written: `folder` is a file, or the picture is wanted
/// and cannot be drawn. An empty folder: nothing is written.
void check_results(const std::filesystem::path& folder, bool picture);

/// Prepares the scan and passes its notes and warnings on, those of the tip only if no other step
/// is to find one.
PreparedAfm prepare(const AfmInput& afm, int threads, const Reporter& reporter,
                    bool warn_of_tip = true);
void warn_of_tip(const PreparedAfm& prepared, const Reporter& reporter);

/// Finds the model for the pixel size of the SEM image. Pixels must be square.
StoredModel model_of(ModelRequest request, const PlacedImage& sem, const Reporter& reporter);

Pose pose_of(const PoseOptions& options, const PreparedAfm& afm, const PlacedImage& sem,
             const StoredModel& model, int threads, const Reporter& reporter);

}  // namespace surf::workflow
