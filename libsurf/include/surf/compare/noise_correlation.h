// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// How errors of neighbouring samples are correlated, the same everywhere.
struct NoiseCorrelation {
  /// Correlation at distances in samples: (reach + dx, reach + dy), 1 in the middle. Odd and
  /// square; symmetric about the middle. Empty: samples are independent.
  Grid<double> by_distance;

  int reach() const { return (by_distance.width() - 1) / 2; }
  double at(int dx, int dy) const;
  /// Variance of a mean of size x size samples, over that of independent ones.
  double inflation(int size) const;
};

/// Estimates the correlation of errors from their signs: sin(pi/2 m), where m is the mean of the
/// products of signs (of normal numbers exactly: Sheppard 1899, doi:10.1098/rsta.1899.0003), so
/// that a few changed places do not matter, however large they are. Values are taken about their
/// median. Correlations that are less than three standard errors, or below 0, count as 0. `reach`
/// is the largest distance along x and y, in samples.
NoiseCorrelation estimate_correlation(const Grid<double>& values, const Mask& used, int reach);

}  // namespace surf
