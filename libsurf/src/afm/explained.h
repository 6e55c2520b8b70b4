// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "tip_carver.h"

namespace surf {

/// How high the tip reaches at each point of a scan without rising above its top by more than the
/// thresholds anywhere: an opening. Points whose bottom is not above it can have been made by the
/// tip.
Grid<float> explained_height(const CarvedScan& scan, const CarvedTip& tip, int threads);

}  // namespace surf
