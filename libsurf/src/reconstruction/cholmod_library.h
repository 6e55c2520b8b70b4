// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices are factorised by CHOLMOD on OpenBLAS, in the module `cholmod`.
#pragma once

#include <memory>

#include "stencil_matrix.h"
#include "surf/core/grid.h"
#include "surf/core/module.h"

namespace surf::reconstruction {

/// The Cholesky factor of a matrix between the samples of an area: see SparseFactor.
class Factor {
 public:
  virtual ~Factor() = default;
  virtual void compute(const StencilMatrix& matrix, const Area& area) = 0;
  virtual Grid<double> solve(const Grid<double>& right) = 0;
  virtual Grid<double> draw(const Grid<double>& normal) = 0;
};

/// The functions of the module.
struct CholmodLibrary {
  static constexpr ModuleName module{
      "cholmod", "reconstructs surfaces",
      "CHOLMOD and OpenBLAS (Debian: libcholmod3, libopenblas0-pthread)", 200};

  std::unique_ptr<Factor> (*make_factor)();
  // Functions of OpenBLAS.
  void (*set_blas_threads)(int count);
  int (*blas_threads)();
  int (*blas_is_parallel)();  ///< 0: OpenBLAS was built for one thread
};

inline const CholmodLibrary& cholmod_library() { return surf::module<CholmodLibrary>(); }

}  // namespace surf::reconstruction
