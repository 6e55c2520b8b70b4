// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

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

/// A wall's numbers by images from above, if what they tell of the height is uncertain by
/// `shading_doubt`. They tell well how far the flank runs along x: another height goes with another
/// angle. Where no wall of these corners is that high only the errors change.
std::array<Measured, profile_numbers> doubted_height(
    const std::array<Measured, profile_numbers>& fitted, const NumberPrior& height);

}  // namespace surf::workflow
