// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/afm/blind_tip.h"
#include "surf/afm/noise.h"

namespace surf {

struct TipSweepOptions {
  /// Size, border, start and threads of each reconstruction. The sweep sets thresholds, apex
  /// tolerance and watch itself.
  BlindTipOptions blind;
  AfmNoise noise;  ///< noise of the scans
  /// Evenly spaced thresholds from `least_nm` to `most_nm`, 0 <= least < most. Both 0: 0.3 to
  /// 8 standard deviations of the noise.
  double least_nm = 0, most_nm = 0;
  int thresholds = 40;                 ///< 2 to 10000
  double tolerance_per_threshold = 1;  ///< apex tolerance, >= 0; 0 is Villarrubia's algorithm
  int draws = 3;                       ///< of the noise, for the expected residuals, 2 to 1000
  std::uint64_t seed = 1;              ///< of the draws
  Watch watch;                         ///< reports thresholds
};

/// A tip of the sweep, with a test whether the noise explains the residuals that it leaves.
struct SweptTip {
  double threshold_nm = 0;
  double volume_nm3 = 0;  ///< between the apex and a depth equal to the range of the scans' heights
  double residual_nm = 0;  ///< root mean square of the scans minus their openings by the tip
  double expected_nm = 0;  ///< mean over draws of the residual of openings with noise added
  double peaks_nm = 0;     ///< mean of the largest thousandth of the residuals
  double expected_peaks_nm = 0;
  /// Whether both residuals agree with the expected ones at least about as well as for any other
  /// tip.
  bool consistent = false;
  Tip tip;
  /// The larger ratio of residual to expected residual: about 1 if the noise explains the
  /// residuals.
  double excess() const;
};

enum class TipSweepVerdict {
  /// The broadest consistent tip is the one just above the largest jump of volume, or near it.
  clear,
  /// The broadest consistent tip lies elsewhere: look at the curve.
  disagreement,
  /// No tip explains the scans: even the best leaves six times the residual that the noise
  /// explains.
  none,
};

struct TipSweep {
  std::vector<SweptTip> curve;  ///< by rising threshold
  std::size_t chosen = 0;       ///< index of the broadest consistent tip
  std::size_t jump = 0;         ///< index of the tip just above the largest jump of volume
  TipSweepVerdict verdict = TipSweepVerdict::clear;
};

/// Chooses the threshold automatically. It reconstructs the tip at many thresholds (Dongmo et al.,
/// J. Vac. Sci. Technol. B 18 (2000) 2385) and opens the scans by each tip. If a tip is too blunt,
/// its opening differs from the scans by more than the noise explains. The expected difference is
/// simulated: noise is added to the opening, and the sum is opened again. Among the tips whose
/// residuals agree best with the expected ones, the broadest is chosen (thesis, 10.1). A tip that
/// is sharpened by noise does not remove the noise: tips do not count if their opening removes less
/// than 0.6 of the noise that the opening by the smoothest tip removes. A threshold blunts the tip,
/// so a little more than the noise always remains. Throws InvalidInput, UsageError, Interrupted.
TipSweep sweep_tips(const std::vector<HeightField>& scans, const TipSweepOptions& options);

/// The threshold and apex tolerance at which, in at least 95 % of noise draws, `blind_tip` gives an
/// outer bound of every touched sample of the true tip. `pixels` is the number of pixels of all
/// scans together. Assumes normal noise, by Bonferroni's inequality over the pixels or over their
/// pairs by a tip of `samples` samples, whichever gives less.
double outer_threshold_nm(const AfmNoise& noise, double pixels, double samples);

/// Directions in which the scans do not determine the tip's shape: the tip falls by no more than
/// `drop_nm` out to its edge. Degrees counter-clockwise from +x, in steps of 10. For a scan of
/// parallel lines these are the directions along the lines.
std::vector<double> unconstrained_directions(const Tip& tip, double drop_nm);

}  // namespace surf
