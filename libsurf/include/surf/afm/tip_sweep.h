// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/afm/blind_tip.h"
#include "surf/afm/noise.h"

namespace surf {

struct TipSweepOptions {
  /// Size, border, start and threads of each reconstruction. Thresholds, apex tolerance and watch
  /// are the sweep's.
  BlindTipOptions blind;
  AfmNoise noise;                      ///< of the scans
  double least_nm = 0, most_nm = 0;    ///< thresholds, evenly from one to the other, 0 <= least <
                                       ///< most; both 0: 0.3 to 8 standard deviations of the noise
  int thresholds = 40;                 ///< 2 to 10000
  double tolerance_per_threshold = 1;  ///< apex tolerance, >= 0; 0 is Villarrubia's algorithm
  int draws = 3;           ///< of the noise, to tell what residuals to expect, 2 to 1000
  std::uint64_t seed = 1;  ///< of the draws
  Watch watch;             ///< counts thresholds
};

/// A tip of the sweep, and whether the noise explains what it leaves of the scans.
struct SweptTip {
  double threshold_nm = 0;
  double volume_nm3 = 0;   ///< down to the range of the scans' heights below the apex
  double residual_nm = 0;  ///< root mean square of the scans less their openings by the tip
  double expected_nm = 0;  ///< the same of openings with the noise added, mean of the draws
  double peaks_nm = 0;     ///< mean of the largest thousandth of the residuals
  double expected_peaks_nm = 0;
  bool consistent = false;  ///< both are as near to what is expected as those of any tip, or nearer
  Tip tip;
  /// The larger of the two over what is expected: about 1 where the noise explains what is left.
  double excess() const;
};

enum class TipSweepVerdict {
  clear,  ///< the broadest consistent tip is the one just above the largest jump of volume, or near
          ///< it
  disagreement,  ///< the broadest consistent tip lies elsewhere: look at the curve
  none,  ///< no tip explains the scans: even the nearest leaves six times as much as the noise
         ///< would
};

struct TipSweep {
  std::vector<SweptTip> curve;  ///< by rising threshold
  std::size_t chosen = 0;       ///< index of the broadest consistent tip
  std::size_t jump = 0;         ///< index of the tip just above the largest jump of volume
  TipSweepVerdict verdict = TipSweepVerdict::clear;
};

/// Finds the threshold by itself: reconstructs the tip at many (Dongmo et al., J. Vac. Sci.
/// Technol. B 18 (2000) 2385), and opens the scans by each. An opening by too blunt a tip lacks
/// more of the scans than the noise explains. What that is, is simulated: noise is added to the
/// opening, and that opened again. Of the tips that come as near to it as any, the broadest is
/// chosen (thesis, 10.1). Tips that noise has sharpened leave it in the scans: those whose opening
/// takes less than 0.6 of the noise away that the smoothest takes do not count. Thresholds blunt
/// tips, so a little more than the noise is always lacking. Throws InvalidInput, UsageError,
/// Interrupted.
TipSweep sweep_tips(const std::vector<HeightField>& scans, const TipSweepOptions& options);

/// The threshold and apex tolerance at which `blind_tip` bounds every touched sample of the true
/// tip from outside in 95 % of noise draws at least, for scans of `pixels` in all. Normal noise: by
/// Bonferroni's inequality over the pixels, or over their pairs by a tip of `samples`, whichever is
/// less.
double outer_threshold_nm(const AfmNoise& noise, double pixels, double samples);

/// Directions in which the scans do not tell the tip's shape: where, out to the edge, it falls by
/// no more than `drop_nm`. Degrees counter-clockwise from +x, in steps of 10; of a scan of parallel
/// lines those along the lines.
std::vector<double> unconstrained_directions(const Tip& tip, double drop_nm);

}  // namespace surf
