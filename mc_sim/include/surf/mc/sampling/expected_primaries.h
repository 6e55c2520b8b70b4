// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/results/simulation_result.h"

namespace surf::mc {

/// How many primaries an accuracy takes, from what a result shows of how each pixel's counts
/// scatter: for planning, within some ten percent. 0 < accuracy; needs a result with an accuracy.
double expected_primaries(const SimulationResult& result, double accuracy);

}  // namespace surf::mc
