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
  bool flat = false;  ///< the whole scan is flat; false: the noise is that of the substrate
  int degree = FlatNoiseOptions{}.degree;
  int lags = NoiseCheckOptions{}.lags;
};
/// The parameters noise.flat, noise.degree and noise.lags.
void describe(ParameterVisitor& visit, ScanNoiseParameters& parameters);

struct ScanNoise {
  NoiseEstimate estimate;
  Mask samples;  ///< 1 for samples that the estimate is made from
  /// The residual of the heights, and that residual whitened by the noise model.
  Grid<double> residual_nm, white;
  double substrate_share = 1;         ///< share of the used samples that lie on the substrate
  std::optional<HoughSummary> plane;  ///< of the substrate
  std::optional<NoiseCheck> check;    ///< absent if there is no noise at all
};

/// Estimates the noise of a scan. Samples that are 0 in `use` (of the scan's size, or empty) are
/// ignored. Throws InvalidInput, UsageError, Interrupted.
ScanNoise noise_of_scan(const HeightField& scan, const ScanNoiseParameters& parameters,
                        const Mask& use = {}, const Reporter& reporter = {});

}  // namespace surf::workflow
