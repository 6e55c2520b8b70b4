// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "gauss_newton.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// Adds a sum of Gaussians of `sigma_px` to the surface. The coefficients are found by nonlinear
/// conjugate gradients (Polak-Ribiere) or L-BFGS with a strong Wolfe line search (thesis, 9.4). Map
/// and mixture stay unchanged. `first`: the current surface is first represented by coefficients
/// itself, by Van Cittert's iteration.
DescentReport descend(const Objective& objective, Unknowns& at, double sigma_px, bool first,
                      ReconstructionMethod method, const DescentOptions& options, int threads);

/// Fits only map and mixture, by Gauss-Newton; the surface stays unchanged.
void fit_few(const Objective& objective, Unknowns& at, const Watch& watch);

}  // namespace surf::reconstruction
