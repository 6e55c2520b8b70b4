// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dissection.h"
#include "stencil_matrix.h"
#include "surf/core/grid.h"

namespace surf::reconstruction {

class Factor;

/// While an object of this class exists, OpenBLAS computes in the calling thread only: threads of
/// its own would compete with ours and change the last bits.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

  /// The number of threads that may call OpenBLAS at once: 1 if it was built without locks,
  /// otherwise unlimited.
  static int most_at_once();

 private:
  int before_;
};

enum class Precision {
  single_where_it_holds,  ///< double where single precision would lose the solution
  double_always,
};

/// The Cholesky factor of a matrix between the samples of an area. It is kept in single precision,
/// which halves memory and time, unless that is too coarse for the matrix: then in double
/// precision, by CHOLMOD. Only one thread at a time may use a factor; keep a OneBlasThread during
/// its use.
class SparseFactor {
 public:
  /// The largest relative error, in the root mean square, that a solution by a factor in single
  /// precision may have before it is refined.
  static constexpr double largest_error = 0.1;

  SparseFactor(std::shared_ptr<const Dissection> order, Precision precision);
  ~SparseFactor();
  SparseFactor(SparseFactor&&) noexcept;

  /// Factorises the matrix, restricted to an area of the dissection's size. Throws InvalidInput if
  /// the matrix is not positive definite, Error if there is not enough memory.
  void compute(std::shared_ptr<const StencilMatrix> matrix, const Area& area);

  /// Replaces each right side by x with A x = right, as exactly as double precision allows: a
  /// solution in single precision is refined by residuals in double precision. If that does not
  /// converge, the factor is made anew in double precision.
  void solve(std::vector<Grid<double>>& x);
  /// The same, with the precision of the factor: a preconditioner.
  void solve_coarsely(std::vector<Grid<double>>& x) const;
  /// Replaces fields of independent standard normal numbers by draws whose covariance is the
  /// inverse of A. Draws of both precisions from the same numbers differ by rounding.
  void draw(std::vector<Grid<double>>& normal) const;

  bool is_single() const { return is_single_; }
  /// The error that `largest_error` limits, as measured for this matrix; 0 in double precision.
  double error() const { return error_; }
  std::size_t bytes() const;
  const Dissection& order() const { return *order_; }

 private:
  bool holds();
  bool refine(std::vector<Grid<double>>& x) const;
  void compute_in_double();

  std::shared_ptr<const Dissection> order_;
  Precision precision_;
  std::shared_ptr<const StencilMatrix> matrix_;
  Area area_;
  std::unique_ptr<Factor> factor_;
  bool is_single_ = false;
  double error_ = 0;
};

}  // namespace surf::reconstruction
