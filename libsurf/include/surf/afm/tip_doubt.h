// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/height_field.h"

namespace surf {

// Reasons not to trust a blind reconstruction, as clauses for people; empty if there is no known
// reason.

/// Doubts about a sweep: no tip explains the scans, or the largest threshold was chosen, so that a
/// larger one may fit as well.
std::string doubt_of_sweep(const TipSweep& sweep);

/// Doubts about a tip's shape: it is flat or hollow, or its radius is over 100 times its width. The
/// scans were then too smooth, or the threshold too high, to show anything of the tip. The radius
/// is that of the end (`measure_tip`); if thresholds have left the end flat, it is that of all
/// samples. Tips of fewer than 6 samples have no radius, and no doubt.
std::string doubt_of_shape(const Tip& tip);

/// The doubts about the sweep and about the shape of the chosen tip.
std::string doubt_of_tip(const TipSweep& sweep);

/// Doubt about noise that was estimated from the scan: it exceeds half of the scan's variance about
/// its mean plane. `estimate_noise` mistakes rough ground for noise; the clause gives
/// `pixel_noise_nm` for comparison.
std::string doubt_of_noise(const AfmNoise& noise, const HeightField& scan);

}  // namespace surf
