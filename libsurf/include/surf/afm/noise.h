// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/grid.h"
#include "surf/core/mask.h"

namespace surf {

/// Noise of an AFM image along its scan lines, e(t) = alpha e(t - 1) + v(t) with independent normal
/// v (thesis, 8.1.1). A scan line is a row from left to right. It begins with a draw from the
/// stationary distribution, of variance innovation / (1 - alpha^2); rows are independent.
struct AfmNoise {
  double alpha = 0;           ///< in (-1, 1); 0: white
  double innovation_nm2 = 1;  ///< variance of v, > 0; 0 for estimates from noiseless heights
  double variance_nm2() const { return innovation_nm2 / (1 - alpha * alpha); }
};

/// Throws InvalidInput (naming `subject`) if alpha is not in (-1, 1) or the innovation's variance
/// is negative, not finite, or 0 where a density is needed (`allow_zero` false).
void validate(const AfmNoise& noise, const char* subject = "noise", bool allow_zero = false);

/// Draws noise in nm. Each row is a function of (seed, row) alone: an image that is smaller above
/// or on the right has the same noise in the remaining part. Throws InvalidInput for an impossible
/// model, UsageError for a size below 1 x 1.
Grid<double> simulate_noise(const AfmNoise& noise, int width, int height, std::uint64_t seed);

/// Whitens residuals: if they follow this noise model, the result is independent standard normal
/// numbers. The prediction of a sample is alpha^k times the last valid sample before it in its row,
/// k columns away. The result is the difference from the prediction, divided by its standard
/// deviation. Samples that are 0 in `valid` (same size, or empty: all count) give 0 and predict
/// nothing. Throws InvalidInput.
Grid<double> whiten(const Grid<double>& residual_nm, const AfmNoise& noise, const Mask& valid = {});

/// The natural logarithm of the density of the residuals (in nm^-n for n samples) under the model.
/// It is exact also for rows with holes, because the process is Markov. If `gradient` is given, it
/// is set to the derivative by each residual, per nm, 0 in holes. The time is proportional to the
/// number of samples. Throws InvalidInput.
double log_likelihood(const Grid<double>& residual_nm, const AfmNoise& noise,
                      const Mask& valid = {}, Grid<double>* gradient = nullptr);

}  // namespace surf
