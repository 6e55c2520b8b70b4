// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Where other places fit the image of the eroded scan nearly as well as the one that was found,
/// asks at each of them for the surface that explains both images best, and how well it does. The
/// likeliest place becomes the pose's map. Leaves poses without rivals as they are.
void judge_places(const ReconstructJob& job, ReconstructSummary& summary, const PlacedImage& image,
                  const AfmData& afm, const Reporter& reporter);

/// A second surface that explains both images, from the likeliest place but one: nothing if that
/// place is less likely than one in twenty, or if its surface is the same within the deviations of
/// both.
std::optional<RivalSurface> rival_surface(const ReconstructJob& job,
                                          const ReconstructSummary& summary, const AfmData& afm,
                                          const SemData& sem, const Reporter& reporter);

}  // namespace surf::workflow
