// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices are factorised on OpenBLAS, in the module `cholmod`: in double precision by
// CHOLMOD.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dissection.h"
#include "stencil_matrix.h"
#include "surf/core/grid.h"
#include "surf/core/module.h"

namespace surf::reconstruction {

/// The Cholesky factor of a matrix between the samples of an area of the dissection's size.
/// Functions for fields take several at once, which reads the factor once for all of them.
class Factor {
 public:
  virtual ~Factor() = default;
  /// Returns false if the matrix is not positive definite in this precision.
  virtual bool compute(const StencilMatrix& matrix, const Area& area) = 0;
  /// Replaces each x by A^-1 x.
  virtual void solve(std::vector<Grid<double>>& x) = 0;
  /// Replaces fields of independent standard normal numbers by draws whose covariance is A^-1. The
  /// number of a sample belongs to the sample's place in the elimination, in any precision.
  virtual void draw(std::vector<Grid<double>>& x) = 0;
  virtual std::size_t bytes() const = 0;
};

/// The functions of the module.
struct CholmodLibrary {
  static constexpr ModuleName module{
      "cholmod", "reconstructs surfaces",
      "CHOLMOD and OpenBLAS (Debian: libcholmod3, libopenblas0-pthread)", 200};

  std::unique_ptr<Factor> (*make_double_factor)(std::shared_ptr<const Dissection> order);
  std::unique_ptr<Factor> (*make_single_factor)(std::shared_ptr<const Dissection> order);
  // Functions of OpenBLAS.
  void (*set_blas_threads)(int count);
  int (*blas_threads)();
  int (*blas_is_parallel)();  ///< 0: OpenBLAS was built for one thread
};

inline const CholmodLibrary& cholmod_library() { return surf::module<CholmodLibrary>(); }

}  // namespace surf::reconstruction
