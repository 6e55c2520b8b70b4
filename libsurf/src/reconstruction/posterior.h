// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "objective.h"
#include "preconditioner.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

/// x with A x = r for the Gauss-Newton second derivative A, by preconditioned conjugate gradients: until the residual,
/// in the preconditioner's norm, is `reduction` of what it was.
Step solve(const Objective& objective, const Unknowns& at, const Objective::State& state, const Preconditioner& m,
           const Step& r, double reduction, const Watch& watch);

struct Posterior {
  Grid<double> deviation_nm;      ///< of the heights, map and mixture free where they are fitted
  Grid<unsigned char> held_by;    ///< see Reconstruction
};

/// The posterior's deviations, linearised: the average of draws from N(0, A^-1), each at the price of a solution. So
/// few draws scatter by a fifth and more; but the variances of the preconditioner, which are exact, hold their
/// detail, and what draws say of the ratio of the two is averaged over a few samples around.
Posterior posterior(const Objective& objective, const Unknowns& at, int draws, std::uint64_t seed, int threads,
                    const Watch& watch);

/// One draw of the error of heights that are found by one linear step at the truth `at`, by noise and the prior's pull.
Grid<double> linear_error(const Objective& objective, const Unknowns& at, const Objective::State& state,
                          const Preconditioner& m, std::uint64_t seed, const Watch& watch);

}  // namespace surf::reconstruction
