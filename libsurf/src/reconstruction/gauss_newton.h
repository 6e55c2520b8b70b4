// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "objective.h"
#include "sparse_factor.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

struct DescentOptions {
  int iterations = 50;
  double tolerance = 1;    ///< nats; ends when an iteration lowers the objective by less
  int most_products = 60;  ///< per iteration
  int threads = 0;
  Precision precision = Precision::single_where_it_holds;
  Watch watch;
};

struct DescentReport {
  int iterations = 0, evaluations = 0, products = 0;
  int factors = 0, double_factors = 0;  ///< see ScaleReport
  double gradient_norm = 0;
  std::string ended;
};

/// Gauss-Newton with a trust region. Each step is computed by preconditioned conjugate gradients
/// (Steihaug 1983, doi:10.1137/0720042), with a second derivative whose SEM part is sparse
/// (SemTerm::Near). It takes as many steps as with the exact second derivative, each in a third of
/// the time. Objective and gradient are exact.
DescentReport gauss_newton(const Objective& objective, Unknowns& at, const DescentOptions& options);

}  // namespace surf::reconstruction
