// SPDX-License-Identifier: GPL-3.0-or-later
// What the module `solvers` is made of, a library in a source each.
#pragma once

#include "solvers.h"

namespace surf::solvers {

Minimised ceres_minimise(const SmoothFunction& function, std::span<double> at,
                         const MinimiseOptions& options);
std::unique_ptr<Factor> make_cholmod_factor();

}  // namespace surf::solvers
