// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surf/core/grid.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// What a model of the SEM image may be off by: sums of quadratic B-splines on wide grids, whose
/// coefficients are independent and normal, times a standard deviation at each pixel, and given
/// fields over the whole image, each times a standard normal coefficient. It is
/// eliminated from the fit: for any simulated image the most likely discrepancy follows from the
/// residual, and the likelihood that is left has the noise's covariance and the discrepancy's.
class Discrepancy {
 public:
  /// Parts and the jitter of rows (see SemData) on the surface's samples, without correlation
  /// between them. Spacings of the grids are the parts' correlation lengths, rounded so that each
  /// is a multiple of the first. Parts rise in length.
  explicit Discrepancy(const std::vector<SemDiscrepancy>& parts,
                       const Grid<double>& row_jitter = {},
                       const std::vector<Grid<double>>& fields = {});
  ~Discrepancy();

  /// For pixels of precisions `weight` (1 / variance of the noise; 0: does not count).
  class Factor;
  std::shared_ptr<const Factor> factor(const Grid<double>& weight) const;

 private:
  struct Layout;
  std::shared_ptr<const Layout> layout_;
};

class Discrepancy::Factor {
 public:
  explicit Factor(std::shared_ptr<const Layout> layout, const Grid<double>& weight);
  ~Factor();

  struct Fit {
    Grid<double> field;                ///< the most likely discrepancy, in the image's unit
    double penalty = 0;                ///< minus the logarithm of its prior, without constants
    std::vector<double> coefficients;  ///< of splines, then of rows, then of fields
  };
  Fit fit(const Grid<double>& residual) const;
  /// By how much what is left of a residual and its penalty rise with each pixel of the residual
  /// through the fit, if `v` is how much what is left counts at each pixel: 0 for weights that are
  /// the noise's.
  Grid<double> spread(const Grid<double>& v, const Fit& fit) const;
  /// Q v, where Q is the inverse of the covariance of noise and discrepancy.
  Grid<double> precision(const Grid<double>& v) const;
  std::vector<double> rows_of(const Fit& fit) const;  ///< the coefficients of rows
  /// A draw of the discrepancy by its prior.
  Grid<double> draw(std::uint64_t seed, std::uint64_t stream) const;

 private:
  friend class Discrepancy;
  struct Solver;
  std::shared_ptr<const Layout> layout_;
  Grid<double> weight_;
  std::unique_ptr<Solver> solver_;
};

}  // namespace surf::reconstruction
