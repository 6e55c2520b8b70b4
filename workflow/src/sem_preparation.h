// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "first_calibration.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Options of a reconstruction that only calibrates, levels or compares: the first scale alone, a
/// few iterations. `gains_tied`: the channels cannot be told apart, so that their gain stays.
ReconstructionOptions coarse_options(const ReconstructJob& job, const ReconstructSummary& summary,
                                     bool gains_tied);

/// The SEM image at a place in the scan, and all that its model may be off by.
SemData sem_at(const ReconstructJob& job, const ReconstructSummary& summary,
               const PlacedImage& image, const Affine& map, const FirstCalibration& calibration);

/// Calibrates the SEM image, estimates its noise, and levels the scan by both images. With a scan
/// all of it is done twice: the eroded scan is too broad where it matters, so a first, coarse
/// reconstruction replaces it. Fills the calibration, noise and tilt of the summary.
SemData prepare_sem(const ReconstructJob& job, ReconstructSummary& summary,
                    const PlacedImage& image, AfmData* afm, const Reporter& reporter);

}  // namespace surf::workflow
