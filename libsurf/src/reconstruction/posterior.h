// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "objective.h"
#include "preconditioner.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

struct Posterior {
  /// Posterior standard deviation; map and mixture are free if they are fitted.
  Grid<double> deviation_nm;
  Grid<unsigned char> data_support;  ///< see Reconstruction
};

/// The posterior standard deviations, linearised: the average over draws from N(0, A^-1). Each draw
/// costs as much as a solution of the linear system, so there are few, and their estimate scatters
/// by a fifth and more. Draws with the preconditioner cost next to nothing and supply the detail;
/// the expensive draws supply the ratio of the two variances, which is averaged over a few
/// neighbouring samples.
///
/// The prior's weights are those of the expected squared curvature, including its variance, as in
/// expectation maximisation for Student's t. The weights at the most likely surface would give too
/// small deviations, because that surface is smoother than any draw. The bias by the prior is added
/// in squares; where edges are rounder than the prior expects, it is the largest part.
Posterior posterior(const Objective& objective, const Unknowns& at, int draws, std::uint64_t seed,
                    int threads, Precision precision, const Watch& watch);

/// One draw of the error, by noise and the prior's bias, of the heights that one linear step at the
/// truth `at` gives.
Grid<double> linear_error(const Objective& objective, const Unknowns& at,
                          const Objective::State& state, const Preconditioner& m,
                          std::uint64_t seed, const Watch& watch);

}  // namespace surf::reconstruction
