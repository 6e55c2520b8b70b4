// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "surf/afm/certainty.h"
#include "surf/afm/noise_estimate.h"
#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"
#include "surf/workflow/level_job.h"

namespace surf::workflow {

/// What is done to a scan before anything is made of it. What is not given is found.
struct AfmPreparationOptions {
  LevelParameters level;
  std::optional<AfmNoise> noise;
  std::optional<Tip> tip;  ///< of any pitch
  int tip_size = 0;  ///< samples across a tip of any shape, odd; 0: a round one is searched for
  std::uint64_t seed = 1;  ///< of the noise that tips are judged by
  int threads = 0;         ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};
/// level.method and so on, scan.height_noise and reconstruction.tip_size; not the tip, nor the
/// seed.
void describe(ParameterVisitor& visit, AfmPreparationOptions& options);

/// A scan ready for use, and all that was found of it on the way.
struct PreparedAfm {
  HeightField image;    ///< levelled; the substrate, where one was found, is at 0
  double tilt_deg = 0;  ///< that was taken off
  AfmNoise noise;
  std::optional<NoiseEstimate> noise_estimate;  ///< absent: it was given
  Tip tip;  ///< of the image's pitch; its doubt is that of its finding, or of its file
  bool tip_given = false;
  bool tip_round = false;             ///< it was taken as round
  double tip_threshold_nm = 0;        ///< of the blind reconstruction, else 0
  CertaintyMap certainty;             ///< and in it the eroded scan
  std::vector<std::string> notes;     ///< what was done, for people
  std::vector<std::string> warnings;  ///< what may have gone wrong, and what to do about it

  const HeightField& eroded() const { return certainty.surface; }
};

/// The first half of the chain (thesis, figure 1-3): level, noise, tip, erosion, certainty.
///
/// The noise is that of the substrate, or where there is no clear one that of the differences
/// between rows and columns. The tip is Villarrubia's, at the threshold that the noise explains
/// (`sweep_tips`), of `tip_size` samples where that is given. Otherwise blind tips of 5, 7, 9, 11,
/// 13, 19 ... 57 samples are found, until one is as wide as the tip is at the scan's full relief,
/// and the tip is the largest round one below them (`tip_below`). Of each blind tip the tenth of
/// directions counts that bounds the tip most, because straight lines and plateaus bound it in few
/// directions. Where no direction bounds the tip, it is one sample, sharp. Throws InvalidInput for
/// scans without relief or noise, UsageError for options out of range, Interrupted.
PreparedAfm prepare_afm(const HeightField& scan, const AfmPreparationOptions& options = {});

}  // namespace surf::workflow
