// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/mask.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// Statistics of whitened residuals, of the pixels that are used.
ResidualReport judge(const Grid<double>& white, const Mask& used);

/// The root mean square of a discrepancy over the standard deviation of an image.
double share_of(const Grid<double>& discrepancy, const Grid<double>& image, const Mask& used);

}  // namespace surf::reconstruction
