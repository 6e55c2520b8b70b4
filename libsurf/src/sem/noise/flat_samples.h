// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surf/core/grid.h"
#include "surf/core/mask.h"
#include "surf/sem/estimate_sem_noise.h"

namespace surf {

/// A displacement of up to two pixels, which stands for its opposite, too: (0, 0) first, then 12
/// others.
struct Lag {
  int dx, dy;
};
inline constexpr int lag_count = 13;
extern const std::array<Lag, lag_count> lags;

using LagSums = std::array<double, lag_count>;

/// The residuals of one region of an image from a polynomial.
struct FlatSample {
  PixelRectangle region;
  std::int64_t pixels = 0;
  double mean = 0;
  double squares = 0, fourths = 0;  ///< sums of powers of the residuals
  LagSums products{};               ///< [lag]: sum of products of residuals; the first is `squares`
  LagSums pairs{};                  ///< [lag]: number of pairs
  int geometry = 0;                 ///< index of its `LagResponse`
};

/// The contribution of noise at each lag of correlation to the expected `products` of a region, per
/// unit of variance. The polynomial removes a part of the noise. Row-major, products by
/// correlations.
using LagResponse = std::array<double, lag_count * lag_count>;

/// Collects samples; regions without holes and of the same size share their response.
class FlatSamples {
 public:
  /// `degree` 0 to 2. Refers to both grids, which have the same size (or `valid` is empty).
  FlatSamples(const Grid<double>& values, const Mask& valid, int degree)
      : values_(values), valid_(valid), degree_(degree) {}

  /// Adds a region, unless it has fewer than four pixels per coefficient.
  bool add(const PixelRectangle& region);

  std::vector<FlatSample> samples;
  std::vector<LagResponse> responses;

  int coefficients() const { return (degree_ + 1) * (degree_ + 2) / 2; }

 private:
  struct Basis {
    int width = 0, height = 0;
    std::vector<int> index;  ///< index of each pixel of the rectangle; -1: not valid
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

/// The noise's correlation at each lag, 1 first, from the residuals of many regions. Each is
/// divided by its variance in `variances` (one per sample; 0: it does not count). Correlations
/// within four standard errors of 0 are set to 0.
LagSums pooled_correlation(const FlatSamples& flat, const std::vector<double>& variances);

/// The variance of the noise in a region, corrected for the part that the polynomial removed.
double variance_of(const FlatSample& sample, const LagResponse& response,
                   const LagSums& correlation);

/// The share of the residuals' power in means of 3 x 3 pixels, times 9: 1 for white noise, 9 for
/// slow structure.
double slow_share(const FlatSample& sample);

/// The sum over all displacements, including the opposite ones.
double sum_of(const LagSums& correlation);
double sum_of_squares(const LagSums& correlation);

}  // namespace surf
