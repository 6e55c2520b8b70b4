// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth functions of many variables are minimised by Ceres, in the module `ceres`.
#pragma once

#include <functional>
#include <span>

#include "surf/core/module.h"

namespace surf::solvers {

/// A smooth function of many variables to be minimised.
class SmoothFunction {
 public:
  virtual ~SmoothFunction() = default;
  virtual int size() const = 0;
  /// Evaluates the function. Returns false if it has no value there. `gradient` is null if it is
  /// not wanted. Exceptions pass through.
  virtual bool evaluate(const double* at, double* value, double* gradient) const = 0;
};

/// conjugate_gradient is the method of Polak and Ribière.
enum class Search { bfgs, lbfgs, conjugate_gradient };

enum class Then { go_on, settled, stop };

struct MinimiseOptions {
  Search search = Search::lbfgs;
  int lbfgs_rank = 20;
  int most_iterations = 50;
  int most_step_sizes = 20;  ///< per line search
  double function_tolerance = 1e-6;
  double gradient_tolerance = 1e-10;
  double parameter_tolerance = 1e-8;
  /// Called after each iteration, 0 being the start, with the decrease of the function.
  std::function<Then(int iteration, double fell)> after;
};

enum class Ended { settled, iterations, line_search, stopped };

struct Minimised {
  Ended ended = Ended::line_search;
  int iterations = 0;
  double value = 0;
};

/// The function of the module `ceres`.
struct CeresLibrary {
  static constexpr ModuleName module{"ceres", "fits models and reconstructs surfaces",
                                     "Ceres (Debian: libceres3)", 200};

  Minimised (*minimise)(const SmoothFunction& function, std::span<double> at,
                        const MinimiseOptions& options);
};

/// Minimises `function`, starting from `at`.
inline Minimised minimise(const SmoothFunction& function, std::span<double> at,
                          const MinimiseOptions& options) {
  return surf::module<CeresLibrary>().minimise(function, at, options);
}

}  // namespace surf::solvers
