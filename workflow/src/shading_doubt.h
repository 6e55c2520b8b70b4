// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/profile/fit_profile.h"

namespace surf::workflow {

/// Images from above tell heights by how dark it is beside walls, in which tiers of physics differ:
/// what they tell is uncertain by this share of the height that is expected, beside all else.
/// Chosen on 18 lines of bench_views.
constexpr double shading_doubt = 0.2;

/// A normal prior of a number; deviation 0: it is held, infinite: nothing is known.
struct NumberPrior {
  double mean = 0, deviation = 0;
};

/// What a number is by its prior and data, if the data are uncertain by `doubt` beside what the fit
/// knew of that gave `fitted` from both.
Measured doubted(const Measured& fitted, const NumberPrior& prior, double doubt);

}  // namespace surf::workflow
