// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/noise.h"
#include "surf/afm/noise_check.h"
#include "surf/core/mask.h"
#include "surf/io/plot.h"

namespace surf::cli {

/// Autocovariance along rows before and after whitening, with the model's, and the density of the
/// whitened residuals with the normal one (thesis, figures 8-2 and 8-3). `samples`: 1 where they
/// count.
io::Plot plot_noise(const Grid<double>& residual_nm, const Grid<double>& white, const Mask& samples,
                    const AfmNoise& noise, const NoiseCheck& check);

}  // namespace surf::cli
