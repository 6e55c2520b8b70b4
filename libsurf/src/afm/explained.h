// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "tip_carver.h"

namespace surf {

/// The height that the tip reaches at each point of a scan without exceeding the top of the scan by
/// more than the thresholds anywhere: an opening. The tip can have made a point if the bottom of
/// the scan is not above this height.
Grid<float> explained_height(const CarvedScan& scan, const CarvedTip& tip, int threads);

}  // namespace surf
