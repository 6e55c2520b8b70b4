// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "objective.h"
#include "preconditioner.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

struct Posterior {
  Grid<double> deviation_nm;    ///< of the heights, map and mixture free where they are fitted
  Grid<unsigned char> held_by;  ///< see Reconstruction
};

/// The posterior's deviations, linearised: the average of draws from N(0, A^-1), each at the price
/// of a solution. So few draws scatter by a fifth and more; but draws of the preconditioner cost
/// next to nothing and hold the detail, and what the dear ones say of the ratio of the two is
/// averaged over a few samples around.
///
/// The prior's weights are those of the curvature that is expected, its own variance included, as
/// expectation maximisation for Student's t has it: those at the most likely surface, which is
/// smoother than any draw, would promise too much. What the prior pulls the surface by is added in
/// squares: where edges are rounder than it expects, that is most of it.
Posterior posterior(const Objective& objective, const Unknowns& at, int draws, std::uint64_t seed,
                    int threads, const Watch& watch);

/// One draw of the error of heights that are found by one linear step at the truth `at`, by noise
/// and the prior's pull.
Grid<double> linear_error(const Objective& objective, const Unknowns& at,
                          const Objective::State& state, const Preconditioner& m,
                          std::uint64_t seed, const Watch& watch);

}  // namespace surf::reconstruction
