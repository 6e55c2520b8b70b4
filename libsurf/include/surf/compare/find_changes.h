// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "surf/compare/noise_correlation.h"
#include "surf/core/affine.h"
#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/core/placement.h"
#include "surf/core/progress.h"

namespace surf {

/// A difference and what is known of its errors. Grids have one size; the unit of values is the
/// caller's.
struct MeasuredDifference : Placement {
  Grid<double> difference;
  /// Standard deviation of random errors, >= 0. Empty: the same everywhere, and estimated.
  Grid<double> deviation;
  /// Standard deviation of errors that are alike over the largest window, such as those of
  /// interpolation along a wall, >= 0. Empty: none.
  Grid<double> systematic;
  /// Errors of the whole field: each is a pattern times an independent number of variance 1.
  std::vector<Grid<double>> common;
  Mask valid;
};

struct ChangeOptions {
  /// Probability that anything is reported where nothing changed, over the whole field, in
  /// [0.001, 0.5].
  double false_alarms = 0.05;
  int smallest_px = 2;  ///< side of the smallest window, samples, >= 1
  /// Side of the largest window, nm. Absent: a quarter of the shorter side, at most 64 samples.
  std::optional<double> largest_nm;
  /// Fields of noise that are simulated. 0: 20 / false_alarms, at least 400.
  int simulations = 0;
  std::optional<NoiseCorrelation> correlation;  ///< absent: estimated from the difference
  /// Given deviations are multiplied by the robust spread of difference / deviation, but by no less
  /// than this, in (0, 1].
  double least_spread = 1;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// A connected region that changed.
struct ChangedPlace {
  Point2 centre_nm;  ///< of its samples
  int samples = 0;
  double area_nm2 = 0;
  double mean = 0, mean_error = 0;      ///< change, its standard error
  double volume = 0, volume_error = 0;  ///< change times area
  double largest = 0;      ///< of the change's samples, with its sign; includes their noise
  double score = 0;        ///< of its strongest window, in standard deviations
  double probability = 0;  ///< that it is no false alarm: 1 - family-wise p
};

struct Changes {
  Grid<double> probability;  ///< of each sample to belong to a change, 1 - family-wise p; 0: hole
  Grid<double> deviation;    ///< total standard deviation of a sample's difference, as used
  Grid<int> place;           ///< number of the sample's place from 1; 0: none
  std::vector<ChangedPlace> places;  ///< strongest first
  double threshold = 0;  ///< score that noise exceeds anywhere with probability `false_alarms`
  /// Robust spread of difference / deviation. Above 1, deviations were too small and are widened.
  /// 0: no deviation was given.
  double spread = 0;
  double estimated_deviation = 0;  ///< where none was given
  NoiseCorrelation correlation;
  std::vector<int> sizes_px;  ///< sides of windows
  int simulations = 0;
};

/// Finds where a difference is more than its errors. Means over square windows of many sizes and
/// places are compared with their standard deviations (matched filters, weighted by inverse
/// variances). The largest of all is compared with the largest in simulated noise with the same
/// deviations, correlation and holes, so that `false_alarms` is the rate for the whole field
/// (Westfall and Young 1993, ISBN 0-471-55761-7). The strongest window is taken as changed by its
/// mean, which is taken off, and so on until noise explains the rest. Throws InvalidInput for sizes
/// that differ, values that are not finite, negative deviations and fewer than 64 valid samples;
/// UsageError for options out of range; Interrupted.
Changes find_changes(const MeasuredDifference& measured, const ChangeOptions& options = {});

}  // namespace surf
