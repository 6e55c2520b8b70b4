// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stencil_matrix.h"
#include "surf/core/grid.h"

namespace surf::reconstruction {

class Factor;

/// While one lives, OpenBLAS computes in the thread that calls it: threads of its own would fight
/// with ours and change the last bits.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

  /// How many threads may call OpenBLAS at once: 1 if it was built without any locks, else as many
  /// as there are.
  static int most_at_once();

 private:
  int before_;
};

/// The Cholesky factor of a matrix between the samples of an area, by CHOLMOD. One thread at a time
/// may use one; keep a OneBlasThread meanwhile.
class SparseFactor {
 public:
  SparseFactor();
  ~SparseFactor();
  SparseFactor(SparseFactor&&) noexcept;

  /// The first call finds the order of elimination; later ones must be of an area of the same size.
  /// Throws InvalidInput if the matrix is not positive definite, Error if memory is short.
  void compute(const StencilMatrix& matrix, const Area& area);

  /// x with A x = right, both of the area's size.
  Grid<double> solve(const Grid<double>& right) const;
  /// Of independent standard normal numbers: a draw whose covariance is the inverse of A.
  Grid<double> draw(const Grid<double>& normal) const;

 private:
  std::unique_ptr<Factor> factor_;
};

}  // namespace surf::reconstruction
