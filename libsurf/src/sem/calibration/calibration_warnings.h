// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/sem/calibration.h"

namespace surf {

/// Judges a fit: sets `outcome` (unless it is undetermined already) and `warnings`. `weights` are 0
/// for pixels that did not count.
void judge(Calibration& c, const CalibrationImages& images, const CalibrationOptions& options,
           const Grid<double>& weights);

}  // namespace surf
