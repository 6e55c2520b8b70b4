// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/plot.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf::cli {

/// Variance against mean with error bars, the line with its error, and the places in the image that
/// the points are from (thesis, figures 8-8 to 8-12).
io::Plot plot_sem_noise(const SemNoiseEstimate& estimate, int width_px, int height_px);

}  // namespace surf::cli
