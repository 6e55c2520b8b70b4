// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/register_job.h"

namespace surf::workflow {

/// The largest distance between where two maps put the SEM image's corners, in pixels.
double apart_px(const Affine& a, const Affine& b, const PlacedImage& sem);

/// Where a registration is not verified, tries the places that rival it, and those that are found
/// with usual tips in place of the blind one, and goes to the one where the scan explains the SEM
/// image best under any tip. The registration's verdict stays: it is of the search that it belongs
/// to. Returns whether the place has changed.
bool go_to_likeliest_place(Pose& pose, const PoseOptions& options, const PreparedAfm& afm,
                           const PlacedImage& sem, const StoredModel& model, int threads,
                           const Reporter& reporter);

}  // namespace surf::workflow
