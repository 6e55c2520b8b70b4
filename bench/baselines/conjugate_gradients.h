// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

namespace surf::bench {

/// The value at a point; the gradient is written to the second argument.
using ValueAndGradient = std::function<double(const std::vector<double>&, std::vector<double>&)>;

struct ConjugateGradientOptions {
  int iterations = 100;     ///< at most
  double tolerance = 1e-4;  ///< ends when an iteration lowers the value by a smaller share of it
};

/// Nonlinear conjugate gradients (Polak and Ribiere), begun again along the gradient wherever a
/// direction does not descend; line search by one secant of the derivative, and halves of it while
/// the value does not fall. `at` is the start, and the end. Returns the value there.
double conjugate_gradients(const ValueAndGradient& function, std::vector<double>& at,
                           const ConjugateGradientOptions& options = {});

}  // namespace surf::bench
