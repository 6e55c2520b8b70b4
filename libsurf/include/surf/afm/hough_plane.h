// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/afm/background.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/progress.h"

namespace surf {

struct HoughOptions {
  /// Half the height of the slab about the plane that counts as the plane, > 0. 0: chosen from the
  /// heights, at least 2.5 standard deviations of the noise's innovation.
  double tolerance_nm = 0;

  Watch watch;
};

enum class HoughVerdict {
  clear,      ///< neither contested nor weak
  contested,  ///< inliers < 1.5 times the runner-up's: another plane has nearly as many samples
  weak,       ///< inliers < 10 %, or < 50 % and < 1.5 times `chance_share`
};

struct HoughSummary {
  Plane plane;   ///< least squares of the inliers
  Mask inliers;  ///< 1 within the tolerance of the plane
  double tolerance_nm = 0;
  double inlier_share = 0;     ///< share of the samples that take part
  Plane runner_up;             ///< best plane of the samples away from `plane`
  double runner_up_share = 0;  ///< share of the samples that take part
  /// Share of evenly spread heights that a slab of this height contains.
  double chance_share = 0;
  double inlier_rms_nm = 0;  ///< root mean square distance of the inliers from the plane
  HoughVerdict verdict = HoughVerdict::clear;
  std::size_t evaluated = 0;  ///< planes counted in the search
  /// False: the search stopped at its limit, and a better plane or runner-up may exist.
  bool search_complete = true;
};

/// Finds the plane, of any tilt, that contains most samples within a tolerance (thesis, 4.1; Hough
/// 1962). It finds the substrate under features, even if the substrate covers less than half of the
/// image.
///
/// A plane is a slope along x and y and an offset; its votes are the samples in a slab about it.
/// The search starts with a box of slopes that contains every plane through at least 20 % of the
/// samples. It halves the most promising box first, as long as the box's upper bound beats the best
/// known plane (branch and bound, Breuel 1992, doi:10.1109/ICPR.1992.201646). The upper bound is
/// the number of votes in a slab that is thickened by as much as the box lets the plane tilt. So no
/// slope is missed. Boxes are no longer halved when they tilt by half the tolerance across the
/// image. Up to 4096 samples vote: one at a random place in each of equal blocks, the same on every
/// run. Planes with 1 % more votes (10 % for the runner-up) may be missed. Afterwards least-squares
/// fits and the selection of inliers from all samples alternate until they agree. The default
/// tolerance, chosen in steps of a factor of two, is the one whose votes are least likely by
/// chance: it maximises the Kullback-Leibler divergence of the share of inliers from the share of
/// evenly spread heights.
///
/// Holes and samples that are 0 in `use` (same size, or empty) do not count. Deterministic. Throws
/// InvalidInput as `fit_plane` does, UsageError for a negative tolerance.
HoughSummary find_plane(const HeightField& field, const HoughOptions& options = {},
                        const Mask& use = {});

}  // namespace surf
