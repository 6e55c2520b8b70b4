// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

namespace surf {

/// How far pixels of an image are off. All but the bias and the mean are relative to each pixel of
/// the reference, where that is darker than a tenth of the mean to a tenth of the mean: what is
/// nearly black would otherwise decide.
struct ImageError {
  std::int64_t pixels = 0;
  double mean_signal = 0;  ///< of the reference, in its unit
  double mean = 0;         ///< of |value - reference|, relative
  double rms = 0;
  double percentile95 = 0;  ///< of |value - reference|, relative
  double largest = 0;
  double bias = 0;             ///< mean of value - reference over the mean signal
  double noise = 0;            ///< rms that the image's own standard errors explain
  double reference_noise = 0;  ///< and those of the reference
  double beyond_noise =
      0;  ///< rms that neither explains: what a model has wrong. 0 where they explain all
};

/// The darkest signal that errors are relative to, as a share of the mean.
inline constexpr double darkest_share = 0.1;

/// Of values beside a reference, pixel by pixel, with the standard errors of both (none: there are
/// none). Throws InvalidInput for other numbers of them, no pixel, what is not finite, or a
/// reference that is nowhere above 0.
ImageError image_error(std::span<const double> values, std::span<const double> standard_errors,
                       std::span<const double> reference, std::span<const double> reference_errors);

}  // namespace surf
