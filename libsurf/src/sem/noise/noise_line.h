// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>
#include "surf/core/mask.h"

#include "flat_samples.h"
#include "grey_levels.h"
#include "variance_line.h"

namespace surf {

/// Checks what SemNoiseOptions says of numbers; UsageError.
void check_options(const SemNoiseOptions& options);

/// Fits the line to `points` and fills in what `estimate` says of it: noise, covariance,
/// slope_known, the test and the range of means. The estimate's own points, as many, are marked.
void set_line(const std::vector<VariancePoint>& points, double least_share, double cut,
              SemNoiseEstimate& estimate);

/// The test of a line that is there already.
void test_line(const std::vector<VariancePoint>& points, const VarianceLine& line,
               double parameters, SemNoiseEstimate& estimate);

/// correlation_x, correlation_y and the sums.
void set_correlation(const LagSums& correlation, SemNoiseEstimate& estimate);

/// Levels that count as saturated, told or found, and how many pixels are. Fills in quantum, black
/// and white.
struct Saturation {
  double black, white;
  bool operator()(double value) const { return value <= black || value >= white; }
};
Saturation find_saturation(const Grid<double>& values, const Mask& valid,
                           const SemNoiseOptions& options, SemNoiseEstimate& estimate);

/// The off-line share, from means of 4 x 4 pixels of `values`.
void set_off_line_share(const Grid<double>& values, const Mask& valid, SemNoiseEstimate& estimate);

/// What people should know of an estimate: `estimate.warnings` gets more.
void add_warnings(SemNoiseEstimate& estimate);

}  // namespace surf
