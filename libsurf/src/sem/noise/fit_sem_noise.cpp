// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "noise_line.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr std::size_t least_pixels = 16, most_bins = 30, least_in_bin = 100;

Mask pixels_that_count(const Grid<double>& real, const Grid<double>& mean, const Mask& used,
                       const SemNoiseOptions& options, SemNoiseEstimate& e) {
  const auto differs = [&](const auto& grid) {
    return grid.width() != real.width() || grid.height() != real.height();
  };
  if (real.empty() || differs(mean) || (!used.empty() && differs(used)))
    throw InvalidInput("SEM noise", "the image, its mean and the mask differ in size",
                       "Give them pixel on pixel");
  for (std::size_t i = 0; i < real.size(); ++i)
    if (used.includes(i) && !(std::isfinite(real.data()[i]) && std::isfinite(mean.data()[i])))
      throw InvalidInput("SEM noise", "a pixel that counts is not finite",
                         "Leave it out by the mask");
  const Saturation saturated = find_saturation(real, used, options, e);
  Mask counts(real.width(), real.height());
  for (std::size_t i = 0; i < real.size(); ++i)
    counts.data()[i] = used.includes(i) && !saturated(real.data()[i]);
  return counts;
}

struct Residual {
  double mean, value;
};

std::vector<Residual> residuals_by_mean(const Grid<double>& real, const Grid<double>& mean,
                                        const Mask& counts) {
  std::vector<Residual> out;
  for (std::size_t i = 0; i < real.size(); ++i)
    if (counts.data()[i]) out.push_back({mean.data()[i], real.data()[i] - mean.data()[i]});
  std::ranges::stable_sort(out, {}, &Residual::mean);
  return out;
}

/// The correlation of the whitened residuals. Values within four standard errors of 0 are set to 0.
LagSums correlation_of(const Grid<double>& white, const Mask& counts) {
  LagSums correlation{1};
  double squares = 0, n = 0;
  for (std::size_t i = 0; i < white.size(); ++i)
    if (counts.data()[i]) squares += white.data()[i] * white.data()[i], n += 1;
  for (std::size_t k = 1; k < lag_count; ++k) {
    double sum = 0, pairs = 0;
    for (int y = 0; y + lags[k].dy < white.height(); ++y)
      for (int x = std::max(0, -lags[k].dx); x < white.width() - std::max(0, lags[k].dx); ++x)
        if (counts(x, y) && counts(x + lags[k].dx, y + lags[k].dy))
          sum += white(x, y) * white(x + lags[k].dx, y + lags[k].dy), pairs += 1;
    if (!(pairs > 0)) continue;
    const double r = sum / pairs / (squares / n);
    if (std::fabs(r) * std::sqrt(pairs) > 4) correlation[k] = std::clamp(r, -1.0, 1.0);
  }
  return correlation;
}

double kurtosis_of(const Grid<double>& white, const Mask& counts) {
  double squares = 0, fourths = 0, n = 0;
  for (std::size_t i = 0; i < white.size(); ++i) {
    if (!counts.data()[i]) continue;
    const double square = white.data()[i] * white.data()[i];
    squares += square, fourths += square * square, n += 1;
  }
  return n * fourths / (squares * squares) - 3;
}

}  // namespace

SemNoiseEstimate fit_sem_noise(const Grid<double>& real, const Grid<double>& mean, const Mask& used,
                               const SemNoiseOptions& options) {
  check_options(options);
  SemNoiseEstimate e;
  const Mask counts = pixels_that_count(real, mean, used, options, e);
  const std::vector<Residual> residuals = residuals_by_mean(real, mean, counts);
  const std::size_t n = residuals.size();
  if (n < least_pixels)
    throw InvalidInput("SEM noise", fmt::format("{} pixels count", n),
                       "Use 16 or more that are not saturated");
  double mean_square = 0;
  for (const Residual& r : residuals) mean_square += r.value * r.value / static_cast<double>(n);
  if (!(mean_square > 0))
    throw InvalidInput("SEM noise", "the model is the image: there is no noise",
                       "Give a real image");

  // Each squared residual is a variance with one degree of freedom, so the fit of their line
  // maximises the likelihood.
  const double least = std::max(options.least_share * mean_square, e.quantum * e.quantum / 12);
  std::vector<VariancePoint> pixels;
  for (const Residual& r : residuals) pixels.push_back({r.mean, r.value * r.value, 1});
  VarianceLine line = fit_variance_line(pixels, {false, least, 0});
  e.noise = {line.slope, line.intercept, least};
  Grid<double> white = whiten(real, mean, e.noise, counts);
  set_correlation(correlation_of(white, counts), e);
  e.excess_kurtosis = kurtosis_of(white, counts);
  const double spread = std::max(2 * e.correlation_squares + e.excess_kurtosis, 0.2) / 2;
  const double range = residuals.back().mean - residuals.front().mean;
  e.slope_known =
      line.covariance[0] > 0 &&
      std::sqrt(spread * line.covariance[0]) * 0.5 * range <=
          0.5 * e.noise.variance(0.5 * (residuals.front().mean + residuals.back().mean));
  if (!e.slope_known) {
    line = fit_variance_line(pixels, {true, least, 0});
    e.noise = {line.slope, line.intercept, least};
  }

  const std::size_t bins = std::clamp<std::size_t>(n / least_in_bin, 1, most_bins);
  std::vector<VariancePoint> points;
  VarianceLine of_bins = line;
  of_bins.used.assign(bins, 1);
  for (std::size_t b = 0; b < bins; ++b) {
    NoisePoint p;
    const std::size_t from = b * n / bins, to = (b + 1) * n / bins;
    double scaled = 0, expected = 0;
    for (std::size_t i = from; i < to; ++i) {
      const double v = e.noise.variance(residuals[i].mean);
      p.mean += residuals[i].mean / static_cast<double>(to - from);
      scaled += residuals[i].value * residuals[i].value / v, expected += 1;
    }
    p.pixels = static_cast<std::int64_t>(to - from);
    p.variance = e.noise.variance(p.mean) * scaled / expected;
    e.points.push_back(p);
    points.push_back({p.mean, p.variance, static_cast<double>(to - from) / spread});
  }
  test_line(points, of_bins, e.slope_known ? 2 : 1, e);
  e.covariance = line.covariance;
  for (double& c : e.covariance) c *= spread * std::max(e.dispersion, 1.0);
  e.least_mean = residuals.front().mean, e.largest_mean = residuals.back().mean;
  set_off_line_share(mean, counts, e);
  add_warnings(e);
  return e;
}

}  // namespace surf
