// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "objective.h"

namespace surf::reconstruction {

/// How much deeper the surface may be where the tip did not reach, nm: a scan only says that it is
/// not higher. Places of no contact are lowered together, in steps, until the signal around them
/// changes by what a model may be off by in narrow places, or they are as low as anything is. This
/// is not linear: deep places look much alike. 0 where the tip touched, and without an SEM image or
/// a scan.
Grid<double> depth_doubt(const Objective& objective, const Unknowns& at,
                         const Objective::State& state, int threads);

}  // namespace surf::reconstruction
