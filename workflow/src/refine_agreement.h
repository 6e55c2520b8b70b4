// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "surf/core/placed_image.h"
#include "surf/refinement/fit_modes.h"
#include "surf/sem/sem_noise.h"

namespace surf::workflow {

/// Noise of an image by its flat places; nothing where it has too few.
std::optional<SemNoise> noise_of_flats(const PlacedImage& image);

/// Noise by what a simulated image leaves, its own chance included.
SemNoise noise_of_rest(const PlacedImage& image, const Grid<double>& simulated,
                       const RefinedViewState& state);

/// Of measured and simulated pixels that count; 0 where one of the two shows nothing.
double correlation(const RefinedView& view);

/// Rms of what gain and offset leave of an image with two simulations, less what noise makes of it,
/// over the signal's deviation. `chance_in_noise`: variances of simulated yields that the noise
/// contains; empty: none. `less_known_errors`: less what the state says that simulations are off
/// by, too.
double unexplained_share(const RefinedView& view, const RefinedViewState& state,
                         const SemNoise& noise, const Grid<double>& chance_in_noise,
                         bool less_known_errors = false);

}  // namespace surf::workflow
