// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/profile/feature_shape.h"
#include "surf/profile/fit_profile.h"

namespace surf::workflow {

/// What images tell of heights by, in which tiers of physics differ.
struct HeightEvidence {
  FeatureKind kind = FeatureKind::line;
  double height_nm = 0;  ///< that is expected
  double tilt_deg = 0;   ///< of the beam, the largest
};

/// What shading in images from above tells of the height is uncertain by, nm.
double shading_doubt_nm(double height_nm);

/// What images tell of the height is uncertain by, nm, beside all that the fit knows of (a standard
/// deviation). From above they tell it by how dark it is beside walls, by tilted beams from how far
/// flanks seem to run, and where a hole's bottom seems to end.
double height_doubt_nm(const HeightEvidence& by);

/// A normal prior of a number; deviation 0: it is held, infinite: nothing is known.
struct NumberPrior {
  double mean = 0, deviation = 0;
};

/// What a number is by its prior and data, if the data are uncertain by `doubt` beside what the fit
/// knew of that gave `fitted` from both. Data that leave a number no surer than its prior tell
/// nothing of it.
Measured doubted(const Measured& fitted, const NumberPrior& prior, double doubt);

/// A wall's numbers, if what images tell of the height is uncertain by `doubt_nm`. They tell well
/// how far the flank runs along x: another height goes with another angle. Where no wall of these
/// corners is that high only the errors change.
std::array<Measured, profile_numbers> doubted_height(
    const std::array<Measured, profile_numbers>& fitted, const NumberPrior& height,
    double doubt_nm);

}  // namespace surf::workflow
