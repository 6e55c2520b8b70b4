// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical libraries that are brought in when they are needed: the module `solvers`.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "surf/core/grid.h"
#include "surf/core/module.h"

namespace surf::reconstruction {
struct Area;
class StencilMatrix;
}  // namespace surf::reconstruction

namespace surf::solvers {

/// A smooth function of many numbers that is to be made small.
class SmoothFunction {
 public:
  virtual ~SmoothFunction() = default;
  virtual int size() const = 0;
  /// False where it has no value. `gradient` is null where it is not wanted. What it throws passes
  /// through.
  virtual bool evaluate(const double* at, double* value, double* gradient) const = 0;
};

enum class Search { bfgs, lbfgs, conjugate_gradient };  ///< the last after Polak and Ribière

enum class Then { go_on, settled, stop };

struct MinimiseOptions {
  Search search = Search::lbfgs;
  int lbfgs_rank = 20;
  int most_iterations = 50;
  int most_step_sizes = 20;  ///< of one line search
  double function_tolerance = 1e-6;
  double gradient_tolerance = 1e-10;
  double parameter_tolerance = 1e-8;
  /// Told of each iteration, 0 being the start, and by how much the function fell.
  std::function<Then(int iteration, double fell)> after;
};

enum class Ended { settled, iterations, line_search, stopped };

struct Minimised {
  Ended ended = Ended::line_search;
  int iterations = 0;
  double value = 0;
};

/// The Cholesky factor of a matrix between the samples of an area: see SparseFactor.
class Factor {
 public:
  virtual ~Factor() = default;
  virtual void compute(const reconstruction::StencilMatrix& matrix,
                       const reconstruction::Area& area) = 0;
  virtual Grid<double> solve(const Grid<double>& right) = 0;
  virtual Grid<double> draw(const Grid<double>& normal) = 0;
};

/// What the module gives.
struct Solvers {
  static constexpr ModuleName module{
      "solvers", "fits models and reconstructs surfaces",
      "Ceres, CHOLMOD and OpenBLAS (Debian: libceres3, libcholmod3, libopenblas0-pthread)", 200};

  /// Lowers `function` from `at`, by Ceres.
  Minimised (*minimise)(const SmoothFunction& function, std::span<double> at,
                        const MinimiseOptions& options);
  /// By CHOLMOD.
  std::unique_ptr<Factor> (*make_factor)();
  // OpenBLAS's own.
  void (*set_blas_threads)(int count);
  int (*blas_threads)();
  int (*blas_is_parallel)();  ///< 0: built for one thread
};

inline const Solvers& solvers() { return surf::module<Solvers>(); }

}  // namespace surf::solvers
