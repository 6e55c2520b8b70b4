// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "surf/afm/background.h"
#include "surf/afm/certainty.h"
#include "surf/afm/noise_estimate.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/workflow/level_job.h"

namespace surf::workflow {

/// How a scan is prepared. Noise and tip are estimated if they are not given.
struct AfmPreparationOptions {
  LevelParameters level;
  std::optional<AfmNoise> noise;
  std::optional<Tip> tip;  ///< tip of any pitch; absent: estimated
  int tip_size = 0;  ///< samples across a tip of any shape, odd; 0: a round tip is searched for
  std::uint64_t seed = 1;  ///< seed of the noise that tips are judged by
  int threads = 0;         ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};
/// The parameters level.method and so on, scan.height_noise and reconstruction.tip_size; neither
/// the tip nor the seed.
void describe(ParameterVisitor& visit, AfmPreparationOptions& options);

/// A prepared scan, with everything found on the way.
struct PreparedAfm {
  HeightField image;       ///< levelled; the substrate, if one was found, is at 0
  double tilt_deg = 0;     ///< tilt that was taken off
  SlopeDoubt level_doubt;  ///< of the tilt that was taken off; 0: none was
  AfmNoise noise;
  bool rough_ground = false;  ///< no plane holds much of the scan: there are no plateaus
  std::optional<NoiseEstimate> noise_estimate;  ///< absent: the noise was given
  Tip tip;  ///< at the image's pitch; its doubt comes from the search or from its file
  bool tip_given = false;
  bool tip_round = false;        ///< the tip was assumed to be round
  bool tip_from_sem = false;     ///< it was found with the SEM image (find_tip_by_sem)
  std::optional<Tip> tip_bound;  ///< the blind tip of any shape that bounds it; absent: not sought
  double tip_threshold_nm = 0;   ///< threshold of the blind reconstruction; else 0
  CertaintyMap certainty;        ///< also holds the eroded scan
  std::vector<std::string> notes;         ///< what was done, for the user
  std::vector<std::string> warnings;      ///< possible mistakes, and what to do about them
  std::vector<std::string> tip_warnings;  ///< the same of the tip, which another step may replace

  const HeightField& eroded() const { return certainty.surface; }
};

/// Does the first half of the chain (thesis, figure 1-3): level, noise, tip, erosion, certainty.
///
/// The noise is estimated on the substrate or, if there is no clear substrate, from the differences
/// between rows and columns. With `tip_size` the tip is Villarrubia's blind tip of that size, at
/// the threshold that the noise explains (`sweep_tips`). Otherwise blind tips of 5, 7, 9, 11, 13,
/// 19 ... 57 samples are found, until one is as wide as the tip is at the scan's full relief. The
/// tip is then the largest round tip below them (`tip_below`). Only the tenth of directions that
/// bounds a blind tip most counts, because straight lines and plateaus bound it in few directions.
/// If no direction bounds the tip, it is one sample: sharp. Throws InvalidInput for scans without
/// relief or noise, UsageError for options out of range, Interrupted.
PreparedAfm prepare_afm(const HeightField& scan, const AfmPreparationOptions& options = {});

}  // namespace surf::workflow
