// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/afm/noise.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

struct RoundTipOptions {
  AfmNoise noise;          ///< noise of the scan
  std::uint64_t seed = 1;  ///< seed of the noise that tips are judged by
  int threads = 0;         ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

struct RoundTipSummary {
  double threshold_nm = 0;  ///< threshold of the last blind tip
  int widest = 0;           ///< samples across the largest blind tip
  bool bounded = false;     ///< false: no direction of any blind tip is deeper than the noise
};

struct RoundTip {
  Tip tip;  ///< one sample, sharp, if nothing bounds the tip
  /// The largest blind tip, of any shape: the true tip is nowhere duller, but for the noise.
  Tip bound;
  RoundTipSummary summary;
};

/// Finds the largest round tip below blind tips of the scan. Blind tips of 5, 7, 9, 11, 13, 19 ...
/// 57 samples are found, each at the threshold that the noise explains (`sweep_tips`), until one is
/// as wide as the round tip is at the scan's full relief. Only the tenth of directions that bound a
/// blind tip most count, because straight lines and plateaus bound a tip in few directions. The
/// tip's doubt is empty if the sweep of any size has none. Throws InvalidInput for a scan whose
/// relief is no higher than its noise or that is too small, UsageError, Interrupted.
RoundTip find_round_tip(const HeightField& scan, const RoundTipOptions& options);

}  // namespace surf
