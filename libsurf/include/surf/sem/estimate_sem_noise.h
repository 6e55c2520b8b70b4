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

/// Pixels [x0, x1) x [y0, y1), columns and rows from the lower-left.
struct PixelRectangle {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  friend bool operator==(const PixelRectangle&, const PixelRectangle&) = default;
};

struct SemNoiseOptions {
  /// Where nothing but noise and slow shading is, one point of the line each. Empty: such places
  /// are found.
  std::vector<PixelRectangle> regions;
  int degree = 2;  ///< of the polynomial that is shading, 0 to 2
  /// Side of the blocks among which flat ones are looked for, 6 to 64. 0: 16, or 12 or 8 where
  /// fewer than 20 of them are flat.
  int block_px = 0;
  /// Pixels at or beyond these levels are saturated. Absent: the image's least or largest level, if
  /// more pixels pile up there than beside it. Infinite: none are.
  std::optional<double> black, white;
  /// SemNoise::least_variance as a share of the median variance, in (0, 1]: no pixel counts more
  /// than 1 / least_share typical ones.
  double least_share = 0.01;
};

/// noise.block, noise.black and noise.white.
void describe(ParameterVisitor& visit, SemNoiseOptions& options);

/// Mean and variance of one flat place.
struct NoisePoint {
  PixelRectangle region;  ///< empty where a model gave the means
  std::int64_t pixels = 0;
  double mean = 0, variance = 0;
  double variance_stderr = 0;  ///< as the fitted line has it
  bool used = true;            ///< false: farther than 3.5 standard errors from the line, left out
};

/// The line variance = slope mean + intercept and how well it is known. All numbers are finite.
struct SemNoiseEstimate {
  SemNoise noise;
  /// Of slope and intercept, row-major; enlarged by `dispersion` where that is above 1.
  std::array<double, 4> covariance{};
  /// False: the means differ by hardly more than their noise, or the variance at either end of them
  /// is not known to half its size; `noise` is a constant then, and the slope's variance in
  /// `covariance` is 0.
  bool slope_known = true;
  std::vector<NoisePoint> points;  ///< by rows of the image; by mean where a model gave the means
  /// Of the used points about the line, each as a standard normal number (Wilson and Hilferty
  /// 1931), the degrees of freedom and the chance of more: small if a line does not describe the
  /// points.
  double chi_squared = 0, p = 1;
  int degrees = 0;
  double dispersion = 1;  ///< chi_squared / degrees; 1 without any
  /// Of a parabola through the points, over its standard error (enlarged as above): beyond 4 the
  /// law bends. And by how much: the most the parabola is off the line, over the line's variance
  /// there.
  double curvature_z = 0, bend = 0;
  double least_mean = 0, largest_mean = 0;  ///< of the used points: beyond them the line is a guess
  /// Share of the image, by the means of 4 x 4 pixels, where the line is below twice the least
  /// variance, so that SemNoise leaves it.
  double off_line_share = 0;
  double correlation_x = 0, correlation_y = 0;  ///< of the noise of neighbours; 0 for a pixel's own
  /// Sums of the noise's correlation (1/25 at least), and of its square, over all distances up to
  /// two pixels: 1 for independent pixels. n pixels are worth n / `correlation_sum` for a mean and
  /// n / `correlation_squares` for a variance.
  double correlation_sum = 1, correlation_squares = 1;
  double excess_kurtosis = 0;         ///< of the noise; 0 if normal
  double quantum = 0;                 ///< step of the grey levels, 0: none. It adds quantum^2 / 12
  std::int64_t black = 0, white = 0;  ///< saturated pixels
  std::int64_t pixels = 0;            ///< in the used points
  int blocks = 0;                     ///< looked at
  std::vector<std::string> warnings;  ///< for people: what is wrong, what to do

  double slope_stderr() const;
  double intercept_stderr() const;
  /// Of the line at an intensity.
  double variance_stderr(double mean) const;
};

/// From flat places of one image. Places that are given are believed. Blocks are chosen by how much
/// of what a polynomial leaves is slow: a ratio, which for normal noise is independent of its
/// variance (Basu 1955), so that choosing does not make the noise too small; the noise of the image
/// may be correlated. Each variance then has the weight of its own error, and points beyond 3.5 of
/// them are left out, until nothing changes. See docs/methods/sem_noise.md. Blocks with pixels that
/// are not valid or more than 0.5 % saturated ones do not count. Throws UsageError for options out
/// of range; InvalidInput for regions outside the image or too small, or if there are no flat
/// blocks, or no noise.
SemNoiseEstimate estimate_sem_noise(const PlacedImage& image, const SemNoiseOptions& options = {});

/// From an image and what a model gives for each of its pixels: the most likely line
/// (log_likelihood in sem_noise.h), by Fisher scoring. What the model is off by counts as noise.
/// Points are of equally many pixels of neighbouring means, about their own mean. Pixels that are 0
/// in `used` (same size, or empty) or saturated do not count; of the options only `black`, `white`
/// and `least_share` do. Throws InvalidInput for sizes that differ, values that are not finite,
/// fewer than 16 pixels, or residuals that are all 0.
SemNoiseEstimate fit_sem_noise(const Grid<double>& real, const Grid<double>& mean,
                               const Mask& used = {}, const SemNoiseOptions& options = {});

}  // namespace surf
