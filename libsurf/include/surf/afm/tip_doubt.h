// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/afm/tip_sweep.h"
#include "surf/core/height_field.h"

namespace surf {

// Why what was found blindly is not to be trusted, in clauses for people; empty where nothing is
// known against it.

/// Of a sweep: no tip explains the scans, or the largest threshold was chosen, so that a larger one
/// may do as well.
std::string doubt_of_sweep(const TipSweep& sweep);

/// Of a tip's shape: it is flat or hollow, or its radius is over 100 times its width. The scans
/// were then too smooth, or the threshold too high, to tell anything of it. The radius is that of
/// the end (`measure_tip`), or, where thresholds have left the end flat, of all samples. Tips of
/// fewer than 6 samples have no radius, and no doubt.
std::string doubt_of_shape(const Tip& tip);

/// Both, of the tip that the sweep chose.
std::string doubt_of_tip(const TipSweep& sweep);

/// Of noise that was estimated from the scan: it takes more than half of the scan's variance about
/// its mean plane. `estimate_noise` takes rough ground for noise; the clause names `pixel_noise_nm`
/// for comparison.
std::string doubt_of_noise(const AfmNoise& noise, const HeightField& scan);

}  // namespace surf
