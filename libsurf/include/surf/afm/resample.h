// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf {

/// The tip at another pitch, by bilinear interpolation; the apex stays a sample and the extent does
/// not grow. A sample is unknown, -infinity, if one of those that it is made of is. Throws
/// InvalidInput for an invalid tip or a pitch that is not positive and finite or so fine that there
/// were more than 2^28 samples.
Tip resampled(const Tip& tip, double pitch_x_nm, double pitch_y_nm);

/// The surface with `factor` samples per pitch, (width - 1) factor + 1 across, by bilinear
/// interpolation; a sample that is made of a hole is a hole. Throws InvalidInput for a factor
/// outside [1, 32].
HeightField upsampled(const HeightField& surface, int factor);

/// The same, smoothly: by cubic convolution (Keys 1981, doi:10.1109/TASSP.1981.1163711), whose
/// slopes are continuous and which reproduces parabolas; bilinear where one of the 16 samples
/// around is a hole.
HeightField smoothly_upsampled(const HeightField& surface, int factor);

/// A tip with `factor` samples per pitch, likewise; the apex stays the highest sample, at 0. Throws
/// InvalidInput for an invalid tip and a factor outside [1, 32].
Tip smoothly_upsampled(const Tip& tip, int factor);

/// The surface at another, square pitch, by bilinear interpolation: the first sample stays where it
/// is, and as many follow as lie within the old ones; a sample that is made of a hole is a hole.
/// Nothing is averaged: with a coarser pitch detail in between is passed over. Throws InvalidInput
/// for a pitch that is not positive and finite, or so coarse or so fine that fewer than 2 x 2 or
/// more than 2^28 samples were left.
HeightField resampled(const HeightField& surface, double pitch_nm);

}  // namespace surf
