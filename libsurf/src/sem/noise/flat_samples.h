// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf {

/// Distances up to two pixels, each with its opposite: (0, 0) first, then 12 others.
struct Lag {
  int dx, dy;
};
inline constexpr int lag_count = 13;
extern const std::array<Lag, lag_count> lags;

using LagSums = std::array<double, lag_count>;

/// What a polynomial leaves of one place of an image.
struct FlatSample {
  PixelRectangle region;
  std::int64_t pixels = 0;
  double mean = 0;
  double squares = 0, fourths = 0;  ///< sums of powers of the residuals
  LagSums products{};               ///< of residuals so far apart, summed; the first is `squares`
  LagSums pairs{};                  ///< number of them
  int geometry = 0;                 ///< index of its `LagResponse`
};

/// What noise of each correlation adds to the expected `products` of a place, per unit of variance:
/// the polynomial takes some of the noise with it. Row-major, products by correlations.
using LagResponse = std::array<double, lag_count * lag_count>;

/// Collects samples; places without holes of the same size share their response.
class FlatSamples {
 public:
  /// `degree` 0 to 2. Refers to both grids, which have the same size (or `valid` is empty).
  FlatSamples(const Grid<double>& values, const Mask& valid, int degree)
      : values_(values), valid_(valid), degree_(degree) {}

  /// Adds a place, unless it has fewer than four pixels for each coefficient.
  bool add(const PixelRectangle& region);

  std::vector<FlatSample> samples;
  std::vector<LagResponse> responses;

  int coefficients() const { return (degree_ + 1) * (degree_ + 2) / 2; }

 private:
  struct Basis {
    int width = 0, height = 0;
    std::vector<int> index;                    ///< of a pixel of the rectangle; -1: not valid
    std::vector<std::vector<double>> columns;  ///< orthonormal, over the valid pixels
    int geometry = 0;
  };
  const Basis& basis_of(const PixelRectangle& region);
  static LagResponse response_of(const Basis& basis);

  const Grid<double>& values_;
  const Mask& valid_;
  int degree_;
  Basis basis_;
};

/// The noise's correlation at each lag, 1 first, from residuals of many places, each over its
/// `variances` (one per sample; 0: it does not count). What is within four standard errors of 0 is
/// 0.
LagSums pooled_correlation(const FlatSamples& flat, const std::vector<double>& variances);

/// Variance of the noise in a place, free of what the polynomial took.
double variance_of(const FlatSample& sample, const LagResponse& response,
                   const LagSums& correlation);

/// Share of the residuals' power in means of 3 x 3 pixels, times 9: 1 for white noise, 9 for slow
/// structure.
double slow_share(const FlatSample& sample);

/// Sum over all distances, those on the other side too.
double sum_of(const LagSums& correlation);
double sum_of_squares(const LagSums& correlation);

}  // namespace surf
