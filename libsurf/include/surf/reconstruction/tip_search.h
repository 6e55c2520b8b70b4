// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/afm/tip.h"
#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/placed_image.h"
#include "surf/core/progress.h"
#include "surf/sem/image_model.h"

namespace surf {

/// A tip that was found with an SEM image: a cone that ends in a sphere, leans, and is wider along
/// one axis than across it.
struct FoundTip {
  Tip tip;  ///< at the scan's pitch
  double radius_nm = 0, half_angle_deg = 0;
  double lean = 0;  ///< relative difference of the slopes on opposite sides, at most
  Affine sem_to_afm;
  /// Root mean square of what the simulated image leaves of the SEM image, in its unit: with the
  /// eroded scan of the given tip, and with that of the found one.
  double residual_before = 0, residual = 0;
};

/// How well the scan explains the SEM image at a place, eroded by the best of ten round tips of
/// radii from 10 to 200 nm: the gain in log-likelihood over an image without any structure, where
/// 50 pixels count as one, because they share what the model is off by. Throws as
/// `find_tip_by_sem`.
double place_evidence(const HeightField& scan, const PlacedImage& sem, const ImageModel& model,
                      const Affine& sem_to_afm, int threads = 0, const Watch& watch = {});

/// A blind tip, which bounds the true one: at no sample is the tip duller than the duller ones of
/// the bound's samples around (a contact is known to one sample), by more than the threshold.
struct TipBound {
  Tip tip;  ///< at the scan's pitch
  double threshold_nm = 0;
};

/// By how many thresholds a tip is duller than the bound allows: the root of the sum of squares
/// over all samples; 0: nowhere. Samples beyond either tip do not count.
double beyond(const TipBound& bound, const Tip& tip);

/// Finds the tip, and the place, whose eroded scan explains the SEM image best: under a tip that is
/// too sharp walls are too wide, under one that is too dull too narrow, and the SEM image shows
/// where they are. Each try erodes the scan and predicts the SEM image of that with one gain for
/// all channels. First radii from 10 to 200 nm are tried, then all numbers are fitted together with
/// the map (BOBYQA, Powell 2009). Numbers that the image does not tell stay near usual ones: a half
/// angle of 25 degrees, no lean, the given map. `scan` is levelled; `tip` is what residual_before
/// is of. Throws InvalidInput where the images do not overlap by 256 pixels, Interrupted.
FoundTip find_tip_by_sem(const HeightField& scan, const Tip& tip, const PlacedImage& sem,
                         const ImageModel& model, const Affine& sem_to_afm, int threads = 0,
                         const Watch& watch = {});

}  // namespace surf
