// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/afm/certainty.h"
#include "surf/afm/tip.h"
#include "surf/core/parameters.h"
#include "surf/workflow/reporter.h"

namespace surf::workflow {

struct CertaintyParameters {
  std::optional<double> noise_nm;  ///< standard deviation; absent: from neighbouring pixels
  double sigmas = CertaintyOptions{}.sigmas;
  /// In pixels; absent: the part of the apex that is flat within the noise.
  std::optional<int> neighbourhood;
  double distance_nm = CertaintyOptions{}.distance_nm;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
};
/// The parameters scan.height_noise, certainty.sigmas, certainty.neighbourhood and
/// certainty.distance.
void describe(ParameterVisitor& visit, CertaintyParameters& parameters);

struct CertaintyResult {
  CertaintyMap map;
  CertaintyParameters used;  ///< the parameters, with the estimated values filled in
  bool trustworthy = true;   ///< false: this tip can have made less than half of the scan
};

/// Computes the certainty map. The tip must have the scan's pitch (`tip_for`). Throws InvalidInput,
/// UsageError, Interrupted.
CertaintyResult certainty(const HeightField& scan, const Tip& tip,
                          const CertaintyParameters& parameters, const Reporter& reporter = {});

}  // namespace surf::workflow
