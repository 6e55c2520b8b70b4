// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>
#include "surf/core/mask.h"

#include "flat_samples.h"
#include "grey_levels.h"
#include "variance_line.h"

namespace surf {

/// Checks the numbers in SemNoiseOptions; throws UsageError.
void check_options(const SemNoiseOptions& options);

/// Fits the line to `points` and sets the corresponding parts of `estimate`: noise, covariance,
/// slope_known, the test and the range of means. Marks the estimate's own points, which correspond
/// to `points`.
void set_line(const std::vector<VariancePoint>& points, double least_share, double cut,
              SemNoiseEstimate& estimate);

/// Tests a given line.
void test_line(const std::vector<VariancePoint>& points, const VarianceLine& line,
               double parameters, SemNoiseEstimate& estimate);

/// Sets correlation_x, correlation_y and the sums of correlations.
void set_correlation(const LagSums& correlation, SemNoiseEstimate& estimate);

/// The levels that count as saturated, from the options or from the image. `find_saturation` also
/// counts the saturated pixels and sets quantum, black and white.
struct Saturation {
  double black, white;
  bool operator()(double value) const { return value <= black || value >= white; }
};
Saturation find_saturation(const Grid<double>& values, const Mask& valid,
                           const SemNoiseOptions& options, SemNoiseEstimate& estimate);

/// Sets off_line_share from means of 4 x 4 pixels of `values`.
void set_off_line_share(const Grid<double>& values, const Mask& valid, SemNoiseEstimate& estimate);

/// Adds warnings about an estimate to `estimate.warnings`.
void add_warnings(SemNoiseEstimate& estimate);

}  // namespace surf
