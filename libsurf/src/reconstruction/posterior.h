// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "objective.h"
#include "preconditioner.h"
#include "surf/core/progress.h"

namespace surf::reconstruction {

struct Posterior {
  /// Posterior standard deviation; map and mixture are free if they are fitted.
  Grid<double> deviation_nm;
  Grid<unsigned char> data_support;  ///< see Reconstruction
};

/// The second derivative A at the end of the fit, and what solves with it.
struct Curvature {
  /// The state at the end, with the prior's weights of the expected squared curvature.
  Objective::State state;
  Objective::Near near;     ///< empty without SEM
  Grid<double> height_nm2;  ///< variances of heights without the SEM image, by cheap draws
  std::unique_ptr<const Preconditioner> preconditioner;  ///< factorised for `state`
};
Curvature expected_curvature(const Objective& objective, const Unknowns& at, std::uint64_t seed,
                             int threads, Precision precision, const Watch& watch);

/// Unknowns of the posterior that the fit did not move.
struct Held {
  bool tip = false, spot = false;
};

/// The prior's bias, which draws of noise do not contain: the displacement of the unknowns that are
/// not held if the prior of the surface were removed, to first order.
Step prior_bias(const Objective& objective, const Unknowns& at, const Curvature& curvature,
                const Held& held, const Watch& watch);

/// What all else changes by, to first order, if the tip is put back to what it was given as: the
/// tip's fit and the search before it are two estimates. Rounded edges of the surface and a tip
/// that is too dull there compensate each other in the scan. So fitted tips are off by far more
/// than noise moves them.
Step change_by_tip(const Objective& objective, const Unknowns& at, const Curvature& curvature,
                   const Held& held, const Watch& watch);

/// The posterior standard deviation of each linear function of the unknowns, which is given by its
/// derivatives c. Its square is c.A^-1 c, which costs a solution of the linear system, and the
/// square of c.bias.
std::vector<double> deviations_of(const Objective& objective, const Unknowns& at,
                                  const Curvature& curvature, const Step& bias,
                                  const std::vector<Step>& functions, const Watch& watch);

/// The posterior standard deviations, linearised: the average over draws from N(0, A^-1). Each draw
/// costs as much as a solution of the linear system, so there are few, and their estimate scatters
/// by a fifth and more. Draws with the preconditioner cost next to nothing and supply the detail;
/// the expensive draws supply the ratio of the two variances, which is averaged over a few
/// neighbouring samples.
///
/// The prior's weights are those of the expected squared curvature, including its variance, as in
/// expectation maximisation for Student's t. The weights at the most likely surface would give too
/// small deviations, because that surface is smoother than any draw. The bias by the prior is added
/// in squares; where edges are rounder than the prior expects, it is the largest part. So is
/// `change_by_tip`, where the tip is fitted.
///
/// `held`: unknowns that draws move, but the fit did not, so that they do not take part in its
/// biases. They have their priors.
Posterior posterior(const Objective& objective, const Unknowns& at, const Held& held, int draws,
                    std::uint64_t seed, int threads, Precision precision, const Watch& watch);

/// One draw of the error, by noise and the prior's bias, of the heights that one linear step at the
/// truth `at` gives.
Grid<double> linear_error(const Objective& objective, const Unknowns& at,
                          const Objective::State& state, const Preconditioner& m,
                          std::uint64_t seed, const Watch& watch);

}  // namespace surf::reconstruction
