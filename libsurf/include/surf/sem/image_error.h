// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

namespace surf {

/// Errors of the pixels of an image. All except the bias and the means are relative to the
/// reference pixel. If the reference is darker than a tenth of its mean, they are relative to a
/// tenth of the mean, because nearly black pixels would dominate otherwise.
struct ImageError {
  std::int64_t pixels = 0;
  double mean_signal = 0;  ///< mean of the reference, in its unit
  double mean = 0;         ///< of |value - reference|, relative
  double rms = 0;
  double percentile95 = 0;  ///< of |value - reference|, relative
  double largest = 0;
  double bias = 0;             ///< mean of value - reference over the mean signal
  double noise = 0;            ///< rms explained by the image's standard errors
  double reference_noise = 0;  ///< rms explained by the reference's standard errors
  /// Rms that neither explains, which is the error of a model; 0 if they explain everything.
  double beyond_noise = 0;
};

/// The smallest signal that errors are relative to, as a share of the mean.
inline constexpr double darkest_share = 0.1;

/// Compares values with a reference, pixel by pixel. Standard errors are optional (empty: none).
/// Throws InvalidInput if the numbers of pixels differ, there is no pixel, a value is not finite,
/// or the mean of the reference is not above 0.
ImageError image_error(std::span<const double> values, std::span<const double> standard_errors,
                       std::span<const double> reference, std::span<const double> reference_errors);

}  // namespace surf
