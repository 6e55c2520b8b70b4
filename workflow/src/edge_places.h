// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

inline constexpr double wall_slope = 0.577;  ///< ground as steep as this, 30 degrees, is a wall

/// How well the lateral places of walls agree with the truth, in the middle of their height: for
/// each wall of the truth that a row or a column crosses, the place where the surface passes that
/// height, against a standard deviation of height over slope there. Walls rise by 10 nm or more,
/// without a sample less steep than 30 degrees. A wall that the surface lacks within 6 pixels is
/// off by these. `truth` is on the surface's samples; `offset_nm` is what the surface is above it.
RegionReport edge_places(const Reconstruction& result, const HeightField& truth, double offset_nm);

}  // namespace surf::workflow
