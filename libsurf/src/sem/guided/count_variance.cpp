// SPDX-License-Identifier: GPL-3.0-or-later
#include "count_variance.h"

#include <algorithm>
#include <cmath>

#include "gaussian_window.h"

namespace surf::guided {
namespace {

// A secondary electron often comes with another: the square mean of a counted primary, for the
// least mean that can be told from 0.
constexpr double least_share = 1e-3;  // of the region's mean
// Of the linear part: where the fitted parabola falls below, as it may at bright ends.
constexpr double least_variance_share = 0.2;
constexpr double most_scale = 4;

}  // namespace

RegionCounts region_counts(const CountImage& counts, const Grid<int>& region, int number) {
  RegionCounts r;
  const Grid<double>& shape = counts[0].primaries;
  r.width = shape.width();
  r.height = shape.height();
  r.seen.assign(shape.size(), 0);
  for (std::size_t i = 0; i < shape.size(); ++i)
    r.seen[i] = (region.empty() || region.data()[i] == number) &&
                counts[0].primaries.data()[i] > 0 && counts[1].primaries.data()[i] > 0;
  for (std::size_t h = 0; h < 2; ++h) {
    HalfCounts& half = r.halves[h];
    half.mean.assign(shape.size(), 0.0);
    half.primaries.assign(shape.size(), 0.0);
    half.scatter.assign(shape.size(), -1.0);
    for (std::size_t i = 0; i < shape.size(); ++i) {
      if (!r.counts(i)) continue;
      const double n = counts[h].primaries.data()[i], sum = counts[h].sum.data()[i];
      half.primaries[i] = n;
      half.mean[i] = sum / n;
      if (n > 1)
        half.scatter[i] =
            std::max(0.0, (counts[h].squares.data()[i] - sum * half.mean[i]) / (n - 1));
    }
  }
  return r;
}

double CountVariance::of_one(double mean) const {
  const double m = std::max(mean, least);
  return std::max(slope * m + square * m * m, least_variance_share * slope * m);
}

std::vector<double> pilot_means(const RegionCounts& counts) {
  const GaussianWindow window(pilot_sigma_px);
  std::vector<double> sums(counts.seen.size(), 0.0), primaries = sums, scratch;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!counts.counts(i)) continue;
    primaries[i] = counts.primaries(i);
    sums[i] = counts.mean(i) * primaries[i];
  }
  window.sum(sums, counts.width, counts.height, scratch);
  window.sum(primaries, counts.width, counts.height, scratch);
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i] = counts.counts(i) ? sums[i] / primaries[i] : 0;
  return sums;
}

CountVariance fit_count_variance(const RegionCounts& counts, const std::vector<double>& pilot,
                                 double library_cascades) {
  CountVariance v;
  double pixels = 0, mean = 0, primaries = 0;
  for (std::size_t i = 0; i < pilot.size(); ++i)
    if (counts.counts(i)) pixels += 1, mean += pilot[i], primaries += counts.primaries(i);
  if (!(pixels > 0)) return v;
  mean /= pixels;
  v.least = std::max(least_share * mean, 0.5 / primaries);
  // Least squares of scatter against m and m^2. Scatter scatters about as its mean does.
  double mm = 0, mq = 0, qq = 0, ms = 0, qs = 0, differences = 0, expected = 0;
  for (std::size_t i = 0; i < pilot.size(); ++i) {
    if (!counts.counts(i)) continue;
    const double m = pilot[i], relative = 1 / std::pow(std::max(m, 0.05 * mean), 2);
    double noise = 0;
    bool known = true;
    for (const HalfCounts& half : counts.halves) {
      known = known && half.scatter[i] >= 0;
      if (!(half.scatter[i] >= 0)) continue;
      const double w = half.primaries[i] * relative;
      mm += w * m * m;
      mq += w * m * m * m;
      qq += w * m * m * m * m;
      ms += w * m * half.scatter[i];
      qs += w * m * m * half.scatter[i];
      noise += half.scatter[i] / half.primaries[i];
    }
    if (!known) continue;
    differences += relative * std::pow(counts.halves[0].mean[i] - counts.halves[1].mean[i], 2);
    expected += relative * noise;
  }
  const double determinant = mm * qq - mq * mq;
  if (mm > 0) v.slope = ms / mm;
  if (determinant > 1e-6 * mm * qq) {
    const double slope = (ms * qq - qs * mq) / determinant;
    // A parabola that begins downward is no variance.
    if (slope > 0) {
      v.slope = slope;
      v.square = (qs * mm - ms * mq) / determinant;
    }
  }
  if (!(v.slope > 0)) v.slope = 1;
  if (expected > 0 && library_cascades > 0) {
    // Where all pixels are alike there are no more different primaries than the library has, and
    // their scatter is known as well as that of so many numbers.
    const double seen = std::clamp(differences / expected, 1 / most_scale, most_scale),
                 before = 2 / library_cascades, doubt = 2 / pixels;
    v.noise_scale = (seen * before + doubt) / (before + doubt);
    v.noise_scale_doubt = before * doubt / (before + doubt);
  }
  return v;
}

}  // namespace surf::guided
