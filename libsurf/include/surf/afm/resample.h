// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"

namespace surf {

/// Resamples a tip to another pitch, by bilinear interpolation. The apex stays a sample and the
/// extent does not grow. A sample is unknown (-infinity) if a sample that it is interpolated from
/// is unknown. Throws InvalidInput for an invalid tip, and for a pitch that is not positive and
/// finite or so fine that more than 2^28 samples were needed.
Tip resampled(const Tip& tip, double pitch_x_nm, double pitch_y_nm);

/// The surface with `factor` samples per pitch, (width - 1) factor + 1 across, by bilinear
/// interpolation. A sample is a hole if a sample that it is interpolated from is a hole. Throws
/// InvalidInput for a factor outside [1, 32].
HeightField upsampled(const HeightField& surface, int factor);

/// Like `upsampled`, but by cubic convolution (Keys 1981, doi:10.1109/TASSP.1981.1163711), whose
/// slopes are continuous and which reproduces parabolas. Bilinear if one of the 16 surrounding
/// samples is a hole.
HeightField smoothly_upsampled(const HeightField& surface, int factor);

/// The tip with `factor` samples per pitch, interpolated smoothly as for a surface. The apex stays
/// the highest sample, at 0. Throws InvalidInput for an invalid tip and a factor outside [1, 32].
Tip smoothly_upsampled(const Tip& tip, int factor);

/// Resamples a surface to another pitch, the same along x and y, by bilinear interpolation. The
/// first sample stays where it is, and as many follow as fit between the old samples. A sample is a
/// hole if a sample that it is interpolated from is a hole. Nothing is averaged: a coarser pitch
/// skips the detail in between. Throws InvalidInput for a pitch that is not positive and finite, or
/// that gives fewer than 2 x 2 or more than 2^28 samples.
HeightField resampled(const HeightField& surface, double pitch_nm);

}  // namespace surf
