// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

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

/// The Cholesky factor of a matrix between the samples of an area, by CHOLMOD. Only one thread at a
/// time may use a factor; keep a OneBlasThread during its use.
class SparseFactor {
 public:
  SparseFactor();
  ~SparseFactor();
  SparseFactor(SparseFactor&&) noexcept;

  /// Factorises the matrix. The first call also finds the order of elimination; later calls must
  /// have an area of the same size. Throws InvalidInput if the matrix is not positive definite,
  /// Error if there is not enough memory.
  void compute(const StencilMatrix& matrix, const Area& area);

  /// x with A x = right, both of the area's size.
  Grid<double> solve(const Grid<double>& right) const;
  /// Turns independent standard normal numbers into a draw whose covariance is the inverse of A.
  Grid<double> draw(const Grid<double>& normal) const;

 private:
  std::unique_ptr<Factor> factor_;
};

}  // namespace surf::reconstruction
