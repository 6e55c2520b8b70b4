// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/hough_plane.h"
#include "surf/afm/noise_check.h"
#include "surf/afm/noise_estimate.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

struct ScanNoiseParameters {
  bool flat = false;  ///< all of the scan is flat; else the noise is that of the substrate
  int degree = FlatNoiseOptions{}.degree;
  int lags = NoiseCheckOptions{}.lags;
};
/// noise.flat, noise.degree and noise.lags.
void describe(ParameterVisitor& visit, ScanNoiseParameters& parameters);

struct ScanNoise {
  NoiseEstimate estimate;
  Mask samples;                       ///< 1 where the estimate is from
  Grid<double> residual_nm, white;    ///< what is left of the heights, and of that by the model
  double substrate_share = 1;         ///< of the samples that take part
  std::optional<HoughSummary> plane;  ///< of the substrate
  std::optional<NoiseCheck> check;    ///< none where there is no noise at all
};

/// Samples that are 0 in `use` (of the scan's size, or empty) play no part. Throws InvalidInput,
/// UsageError, Interrupted.
ScanNoise noise_of_scan(const HeightField& scan, const ScanNoiseParameters& parameters,
                        const Mask& use = {}, const Reporter& reporter = {});

}  // namespace surf::workflow
