// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/afm/background.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/progress.h"

namespace surf {

struct HoughOptions {
  /// Half the height of the slab about the plane within which a sample belongs to it; > 0, or 0:
  /// chosen from the heights, at least 2.5 standard deviations of their noise's innovation.
  double tolerance_nm = 0;

  Watch watch;
};

enum class HoughVerdict {
  clear,      ///< neither of these
  contested,  ///< inliers < 1.5 times the runner-up's: another plane holds nearly as many samples
  weak,       ///< inliers < 10 %, or < 50 % and < 1.5 times what evenly spread heights would give
};

struct HoughSummary {
  Plane plane;   ///< least squares of the inliers
  Mask inliers;  ///< 1 within the tolerance of the plane
  double tolerance_nm = 0;
  double inlier_share = 0;     ///< of the samples that take part
  Plane runner_up;             ///< the best plane of the samples away from the first
  double runner_up_share = 0;  ///< likewise of all that take part
  double chance_share = 0;     ///< what a slab of this height holds of heights spread evenly
  double inlier_rms_nm = 0;    ///< of the inliers about the plane
  HoughVerdict verdict = HoughVerdict::clear;
  std::size_t evaluated = 0;    ///< planes counted in the search
  bool search_complete = true;  ///< false: stopped at its limit, a better plane or rival may exist
};

/// The plane that most samples lie on, within a tolerance, of whatever tilt (thesis, 4.1; Hough
/// 1962): the substrate under features, also where it is less than half of the image.
///
/// A plane is a slope along x and y and an offset; its votes are the samples in a slab about it.
/// Slopes are searched from one box that holds all that 20 % of the samples can have, halved where
/// the box's upper bound (the votes in a slab as much thicker as the box lets the plane tilt) beats
/// the best plane known, most promising first (branch and bound, Breuel 1992,
/// doi:10.1109/ICPR.1992.201646). So no slope is missed, whatever the tilt, and boxes end only when
/// they tilt by half the tolerance across the image. Votes come from up to 4096 samples, one from
/// each of equal blocks at a random place, the same on every run; planes with 1 % more votes (10 %
/// for the runner-up) may be missed. Then least squares and inliers of all samples take turns until
/// they agree. The tolerance is the one, in steps of a factor of two, whose votes are the least
/// likely by chance: the Kullback-Leibler divergence of the share of inliers from that of evenly
/// spread heights.
///
/// Samples that are 0 in `use` (same size, or empty) and holes play no part. Deterministic.
/// Throws InvalidInput as `fit_plane` does, UsageError for a negative tolerance.
HoughSummary find_plane(const HeightField& field, const HoughOptions& options = {},
                        const Mask& use = {});

}  // namespace surf
