// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "surf/mc/physics/medium.h"

namespace surf::mc {

/// How far from its start an electron or one that it frees gets in an endless medium without
/// continuous loss, at the edges of the energy bins, nm: a distance that less than one in a million
/// exceeds. It is measured up to some 500 eV, on a few thousand electrons of each energy, whose
/// tail is taken for exponential; above, more than a straight way down to there is added. The same
/// for the same medium.
std::vector<double> measured_reach_nm(
    const Medium& medium, const std::function<double(double energy_ev)>& stopping_power_ev_per_nm);

}  // namespace surf::mc
