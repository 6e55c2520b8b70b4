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
  /// Samples of the tip, >= 1, no larger than a scan; the apex is in the middle.
  int width = 15, height = 15;
  AfmNoise noise;       ///< of all scans
  int iterations = 64;  ///< of the last fit, >= 1; the first fit takes an eighth of them
  int threads = 0;      ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// A fitted tip that started from the outer bound at some threshold.
struct TipCandidate {
  double threshold_nm = 0;  ///< of the outer bound
  double tolerance = 0;     ///< apex tolerance of the outer bound, in thresholds
  double misfit = 0;        ///< e' R^-1 e per pixel; below 1 if the fit follows the noise
  double freedom = 0;       ///< touched surface pixels per image pixel
  /// Stein's estimate of the error, up to a constant: misfit + 2 freedom; of a candidate after the
  /// first fit, as it would be with its superfluous pixels taken away.
  double risk = 0;
};

struct BestTipSummary {
  /// After the first fit, ordered by tolerance and then by falling threshold.
  std::vector<TipCandidate> candidates;
  TipCandidate chosen;             ///< after the last fit
  Grid<double> standard_error_nm;  ///< per sample of the tip; infinity without contact
  std::int64_t touched = 0;        ///< samples of the tip that touched something
};

struct BestTip {
  Tip tip;
  BestTipSummary summary;
};

/// Finds the tip and the surfaces that maximise the likelihood of the scans: scan = dilation of the
/// surface by the tip plus noise. The surfaces are free, so a sharper tip always fits better,
/// because it also follows the noise. Two terms keep the tip blunt; neither needs a parameter set
/// by hand:
/// - The likelihood of a sample falls by a factor e for each standard deviation of the noise by
///   which it lies deeper. A few contacts outweigh this prior; samples that touch nothing are
///   raised by it.
/// - Fits start from 32 outer bounds of `blind_tip`, with thresholds of 2.5 to 7 standard
///   deviations (closer together where the tip's volume jumps) and two apex tolerances. They are
///   compared by Stein's unbiased risk estimate (Ann. Stat. 9 (1981) 1135), which counts the
///   surface pixels in use.
///
/// The likelihood is maximised by scaled gradient steps, with derivatives taken at the contacts of
/// the dilation. Several scans by the same tip are fitted together; all scans have the same pitch.
/// Throws InvalidInput, UsageError, Interrupted.
BestTip best_tip(const std::vector<HeightField>& scans, const BestTipOptions& options);

}  // namespace surf
