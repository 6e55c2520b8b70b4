// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/affine.h"
#include "surf/core/landmark_pair.h"

namespace surf {

struct LandmarkFit {
  Affine sem_to_afm;
  std::vector<double> residuals_nm;  ///< distance of each pair in the AFM's frame
  double rms_nm = 0;                 ///< root mean square residual; always 0 for three pairs
};

/// Fits the affine map that brings the SEM's points closest to the AFM's, by least squares (thesis,
/// 7.2.4). Throws InvalidInput for fewer than three pairs, for points that are not finite, and if
/// the pairs do not determine the map. The message then names the pairs (counted from 1) that
/// coincide or that all lie on a line.
LandmarkFit fit_landmarks(const std::vector<LandmarkPair>& pairs);

}  // namespace surf
