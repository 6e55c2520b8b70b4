// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "gauss_newton.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// The surface's heights plus a sum of Gaussians of `sigma_px`, whose coefficients are found by
/// nonlinear conjugate gradients (Polak-Ribiere) or L-BFGS with a strong Wolfe line search
/// (thesis, 9.4). Map and mixture stay. `first`: the surface so far is given up for its own
/// coefficients, found by Van Cittert's iteration.
DescentReport descend(const Objective& objective, Unknowns& at, double sigma_px, bool first,
                      ReconstructionMethod method, const DescentOptions& options, int threads);

/// Map and mixture alone, by Gauss-Newton; the surface stays.
void fit_few(const Objective& objective, Unknowns& at, const Watch& watch);

}  // namespace surf::reconstruction
