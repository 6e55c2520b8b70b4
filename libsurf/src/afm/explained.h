// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/grid.h"
#include "tip_carver.h"

namespace surf {

/// The height of the apex at each place where the tip, lowered from above, first exceeds the top of
/// the scan by the threshold of some sample: an erosion. Laid out like the scan; infinity where
/// nothing is met.
std::vector<float> apex_heights(const CarvedScan& scan, const CarvedTip& tip, int threads);

/// The height that the tip reaches at each point of a scan with its apex at `apex_heights`: with
/// those an opening. The tip can have made a point if the bottom of the scan is not above this
/// height.
Grid<float> explained_height(const CarvedScan& scan, const std::vector<float>& apex,
                             const CarvedTip& tip, int threads);

}  // namespace surf
