// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "surf/core/mask.h"

#include "surf/core/parameters.h"
#include "surf/core/placed_image.h"
#include "surf/sem/sem_noise.h"

namespace surf {

/// The pixels [x0, x1) x [y0, y1): columns and rows from the lower left.
struct PixelRectangle {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  friend bool operator==(const PixelRectangle&, const PixelRectangle&) = default;
};

struct SemNoiseOptions {
  /// Regions that contain only noise and slow shading; each gives one point of the line. Empty:
  /// such regions are searched for.
  std::vector<PixelRectangle> regions;
  int degree = 2;  ///< degree of the polynomial that models the shading, 0 to 2
  /// Side of the blocks that are tested for flatness, 6 to 64. 0: 16, or 12 or 8 if fewer than 20
  /// blocks are flat.
  int block_px = 0;
  /// Pixels at or beyond these levels are saturated. Absent: the image's lowest or highest level,
  /// if more pixels pile up there than beside it. Infinite: no pixel is saturated.
  std::optional<double> black, white;
  /// SemNoise::least_variance as a share of the median variance, in (0, 1]. No pixel has more
  /// weight than 1 / least_share typical pixels.
  double least_share = 0.01;
};

/// Describes the parameters noise.block, noise.black and noise.white.
void describe(ParameterVisitor& visit, SemNoiseOptions& options);

/// Mean and variance of one flat region.
struct NoisePoint {
  PixelRectangle region;  ///< empty if a model gave the means
  std::int64_t pixels = 0;
  double mean = 0, variance = 0;
  double variance_stderr = 0;  ///< according to the fitted line
  bool used = true;            ///< false: left out, farther than 3.5 standard errors from the line
};

/// The line variance = slope mean + intercept and its uncertainty. All numbers are finite.
struct SemNoiseEstimate {
  SemNoise noise;
  /// Covariance of slope and intercept, row-major; enlarged by `dispersion` if that is above 1.
  std::array<double, 4> covariance{};
  /// False: the means differ by hardly more than their noise, or the variance at either end of
  /// their range is uncertain by more than half. Then `noise` is constant, and the slope's variance
  /// in `covariance` is 0.
  bool slope_known = true;
  std::vector<NoisePoint> points;  ///< by rows of the image; by mean if a model gave the means
  /// Chi-squared of the used points about the line, each converted to a standard normal number
  /// (Wilson and Hilferty 1931), with its degrees of freedom and the probability of a larger value.
  /// The probability is small if a line does not describe the points.
  double chi_squared = 0, p = 1;
  int degrees = 0;
  double dispersion = 1;  ///< chi_squared / degrees; 1 without degrees of freedom
  /// The coefficient of a parabola through the points over its standard error (enlarged as above):
  /// beyond 4 the relation is not linear. `bend` is the largest difference between parabola and
  /// line over the line's variance there.
  double curvature_z = 0, bend = 0;
  /// Means of the used points; outside this range the line is an extrapolation.
  double least_mean = 0, largest_mean = 0;
  /// Share of the image, by the means of 4 x 4 pixels, in which the line is below twice the least
  /// variance, so that SemNoise departs from it.
  double off_line_share = 0;
  /// Correlation of the noise of neighbouring pixels; 0 if independent.
  double correlation_x = 0, correlation_y = 0;
  /// Sums of the noise's correlation (at least 1/25), and of its square, over all distances up to
  /// two pixels: 1 for independent pixels. n pixels are worth n / `correlation_sum` for a mean and
  /// n / `correlation_squares` for a variance.
  double correlation_sum = 1, correlation_squares = 1;
  double excess_kurtosis = 0;  ///< of the noise; 0 if normal
  double quantum = 0;  ///< step of the grey levels, 0: none. It adds quantum^2 / 12 to the variance
  std::int64_t black = 0, white = 0;  ///< saturated pixels
  std::int64_t pixels = 0;            ///< in the used points
  int blocks = 0;                     ///< blocks that were tested
  std::vector<std::string> warnings;  ///< for people: what is wrong, what to do

  double slope_stderr() const;
  double intercept_stderr() const;
  /// Standard error of the line at an intensity.
  double variance_stderr(double mean) const;
};

/// Estimates the noise from flat regions of one image. Given regions are not tested. Blocks are
/// chosen by the share of slow variations in their residuals from a polynomial. For normal noise
/// this ratio is independent of the variance (Basu 1955), so the choice does not make the noise too
/// small; the noise may be correlated. In the fit, each variance has the weight of its own error.
/// Points beyond 3.5 standard errors are left out, until nothing changes. See
/// docs/explanation/sem_noise.md. Blocks with invalid pixels or more than 0.5 % saturated pixels do
/// not count. Throws UsageError for options out of range; InvalidInput for regions outside the
/// image or too small, and if there are no flat blocks or no noise.
SemNoiseEstimate estimate_sem_noise(const PlacedImage& image, const SemNoiseOptions& options = {});

/// Estimates the noise from an image and the model's value for each of its pixels: the most likely
/// line (log_likelihood in sem_noise.h), by Fisher scoring. Errors of the model count as noise.
/// Each point consists of equally many pixels of similar means. Pixels that are 0 in `used` (same
/// size, or empty) or saturated do not count. Of the options, only `black`, `white` and
/// `least_share` are used. Throws InvalidInput for sizes that differ, values that are not finite,
/// fewer than 16 pixels, or residuals that are all 0.
SemNoiseEstimate fit_sem_noise(const Grid<double>& real, const Grid<double>& mean,
                               const Mask& used = {}, const SemNoiseOptions& options = {});

}  // namespace surf
