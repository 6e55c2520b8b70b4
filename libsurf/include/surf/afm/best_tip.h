// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

struct BestTipOptions {
  int width = 15,
      height = 15;      ///< samples of the tip, >= 1, no larger than a scan; apex in the middle
  AfmNoise noise;       ///< of all scans
  int iterations = 64;  ///< of the last fit, >= 1; the first takes an eighth
  int threads = 0;      ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// A tip that was fitted, from the outer bound at some threshold.
struct TipCandidate {
  double threshold_nm = 0;  ///< of the outer bound
  double tolerance = 0;     ///< apex tolerance of the bound, in thresholds
  double misfit = 0;        ///< e' R^-1 e per pixel: below 1 where noise is fitted, too
  double freedom = 0;       ///< surface pixels that are touched, per pixel
  double risk = 0;  ///< misfit + 2 freedom: Stein's estimate of the error, but for a constant
};

struct BestTipSummary {
  std::vector<TipCandidate>
      candidates;                  ///< after the first fit, by tolerance and falling threshold
  TipCandidate chosen;             ///< after the last fit
  Grid<double> standard_error_nm;  ///< per sample of the tip; infinity where nothing touched it
  std::int64_t touched = 0;        ///< samples of the tip that touched something
};

struct BestTip {
  Tip tip;
  BestTipSummary summary;
};

/// The tip and the surfaces that make the scans most likely: scan = dilation of the surface by the
/// tip plus noise. Surfaces are free, so sharper tips always fit better, noise as well as the
/// surface. Two things keep the tip blunt, and neither needs a number set by hand:
/// - a sample is less likely by a factor e for each standard deviation of the noise that it lies
/// deeper: a
///   pull that a few contacts outweigh, and that raises what nothing touches;
/// - fits from 32 of blind_tip's outer bounds, at thresholds of 2.5 to 7 standard deviations,
/// closer where
///   the tip's volume jumps, and two apex tolerances, are compared by
///   Stein's unbiased risk estimate (Ann. Stat. 9 (1981) 1135), which counts the surface's pixels
///   in use.
/// The likelihood is followed by scaled gradient steps through the contacts of the dilation.
/// Several scans by one tip are fitted together; all have one pitch. Throws InvalidInput,
/// UsageError, Interrupted.
BestTip best_tip(const std::vector<HeightField>& scans, const BestTipOptions& options);

}  // namespace surf
