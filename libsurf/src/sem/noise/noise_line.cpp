// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "surf/afm/noise_check.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int off_line_block = 4;
// Least ratio of the variance of the means to that of their noise; at the limit the slope is 10 %
// too small.
constexpr double least_spread = 10;
constexpr double least_correlation_sum = 1.0 / 25;  // it sums over 25 pixels

double median_variance(const std::vector<VariancePoint>& points) {
  std::vector<double> v;
  for (const VariancePoint& p : points) v.push_back(p.variance);
  std::ranges::nth_element(v, v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2));
  return v[v.size() / 2];
}

struct Range {
  double least = infinity, largest = -infinity;
};

Range means_of(const std::vector<VariancePoint>& points, const std::vector<char>& used) {
  Range r;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (used[i])
      r.least = std::min(r.least, points[i].mean), r.largest = std::max(r.largest, points[i].mean);
  return r;
}

/// Whether the means differ by more than their noise. Otherwise the slope could be a chance
/// correlation of mean and variance.
bool spread_is_real(const SemNoiseEstimate& e, const std::vector<char>& used) {
  double n = 0, mean = 0, squares = 0, error = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const NoisePoint& p = e.points[i];
    const double from = p.mean - mean;
    n += 1, mean += from / n, squares += from * (p.mean - mean);
    error += p.variance * e.correlation_sum / static_cast<double>(p.pixels);
  }
  return squares > least_spread * error;
}

}  // namespace

double SemNoiseEstimate::slope_stderr() const { return std::sqrt(covariance[0]); }
double SemNoiseEstimate::intercept_stderr() const { return std::sqrt(covariance[3]); }
double SemNoiseEstimate::variance_stderr(double mean) const {
  return std::sqrt(
      std::max(0.0, covariance[0] * mean * mean + 2 * covariance[1] * mean + covariance[3]));
}

void check_options(const SemNoiseOptions& o) {
  if (o.degree < 0 || o.degree > 2)
    throw UsageError("SEM noise", fmt::format("a polynomial of degree {}", o.degree),
                     "Choose 0, 1 or 2");
  if (o.block_px != 0 && (o.block_px < 6 || o.block_px > 64))
    throw UsageError("SEM noise", fmt::format("blocks of {} pixels", o.block_px),
                     "Choose 6 to 64, or 0");
  if (!(o.least_share > 0 && o.least_share <= 1))
    throw UsageError("SEM noise",
                     fmt::format("a least variance of {} of the median", o.least_share),
                     "Give a share above 0 and up to 1");
  if ((o.black && std::isnan(*o.black)) || (o.white && std::isnan(*o.white)) ||
      (o.black && o.white && !(*o.black < *o.white)))
    throw UsageError("SEM noise", "the black level is not below the white one",
                     "Give levels in this order, or none");
}

Saturation find_saturation(const Grid<double>& values, const Mask& valid,
                           const SemNoiseOptions& options, SemNoiseEstimate& e) {
  const GreyLevels levels = grey_levels(values, valid);
  e.quantum = levels.quantum;
  const Saturation s{options.black.value_or(levels.black.value_or(-infinity)),
                     options.white.value_or(levels.white.value_or(infinity))};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!valid.empty() && !valid.data()[i]) continue;
    e.black += values.data()[i] <= s.black;
    e.white += values.data()[i] >= s.white;
  }
  return s;
}

void set_correlation(const LagSums& correlation, SemNoiseEstimate& e) {
  for (std::size_t k = 0; k < lag_count; ++k) {
    if (lags[k].dx == 1 && lags[k].dy == 0) e.correlation_x = correlation[k];
    if (lags[k].dx == 0 && lags[k].dy == 1) e.correlation_y = correlation[k];
  }
  e.correlation_sum = std::max(sum_of(correlation), least_correlation_sum);
  e.correlation_squares = sum_of_squares(correlation);
}

void test_line(const std::vector<VariancePoint>& points, const VarianceLine& line,
               double parameters, SemNoiseEstimate& e) {
  double count = -parameters;
  e.chi_squared = 0, e.pixels = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    e.points[i].used = line.used[i] != 0;
    const double v = e.noise.variance(points[i].mean);
    e.points[i].variance_stderr = v * std::sqrt(2 / points[i].freedom);
    if (!line.used[i]) continue;
    const double z = score(points[i], v);
    e.chi_squared += z * z;
    e.pixels += e.points[i].pixels;
    ++count;
  }
  e.degrees = std::max(0, static_cast<int>(count));
  e.p = e.degrees > 0 ? chi_squared_tail(e.chi_squared, e.degrees) : 1;
  e.dispersion = e.degrees > 0 ? e.chi_squared / e.degrees : 1;
  const Range means = means_of(points, line.used);
  e.least_mean = means.least, e.largest_mean = means.largest;
  if (e.degrees < 2) return;
  const Curvature curvature = fit_curvature(points, line, e.noise.least_variance);
  e.curvature_z = curvature.z / std::sqrt(std::max(e.dispersion, 1.0));
  e.bend = curvature.departure;
}

void set_line(const std::vector<VariancePoint>& points, double least_share, double cut,
              SemNoiseEstimate& e) {
  const double least = std::max(least_share * median_variance(points), e.quantum * e.quantum / 12);
  VarianceLineOptions options{false, least, cut};
  VarianceLine line = fit_variance_line(points, options);
  const Range means = means_of(points, line.used);
  const double middle = 0.5 * (means.least + means.largest);
  // Half the range of means times the slope's error: the additional uncertainty at an end of the
  // range compared to the middle.
  const double unknown = std::sqrt(line.covariance[0]) * 0.5 * (means.largest - means.least);
  e.slope_known = line.covariance[0] > 0 && spread_is_real(e, line.used) &&
                  unknown <= 0.5 * std::fabs(line.slope * middle + line.intercept);
  if (!e.slope_known) {
    options.constant = true;
    line = fit_variance_line(points, options);
  }
  e.noise = {line.slope, line.intercept, least};
  test_line(points, line, e.slope_known ? 2 : 1, e);
  e.covariance = line.covariance;
  for (double& c : e.covariance) c *= std::max(e.dispersion, 1.0);
}

void set_off_line_share(const Grid<double>& values, const Mask& valid, SemNoiseEstimate& e) {
  std::int64_t blocks = 0, off = 0;
  for (int y = 0; y + off_line_block <= values.height(); y += off_line_block)
    for (int x = 0; x + off_line_block <= values.width(); x += off_line_block) {
      double sum = 0;
      bool whole = true;
      for (int j = 0; j < off_line_block; ++j)
        for (int i = 0; i < off_line_block; ++i) {
          whole = whole && valid.includes(x + i, y + j);
          if (whole) sum += values(x + i, y + j);
        }
      if (!whole) continue;
      ++blocks;
      off += e.noise.slope * sum / (off_line_block * off_line_block) + e.noise.intercept <
             2 * e.noise.least_variance;
    }
  e.off_line_share = blocks ? static_cast<double>(off) / static_cast<double>(blocks) : 0;
}

void add_warnings(SemNoiseEstimate& e) {
  const auto warn = [&](std::string text) { e.warnings.push_back(std::move(text)); };
  const double typical = e.noise.variance(0.5 * (e.least_mean + e.largest_mean));
  if (!e.slope_known)
    warn(
        fmt::format("the means range from {:.4g} to {:.4g} only, too little to tell how the "
                    "variance changes with "
                    "intensity: it is taken as constant. Give regions of other brightness",
                    e.least_mean, e.largest_mean));
  if (e.slope_known && e.noise.slope < 0 && -e.noise.slope > 3 * e.slope_stderr())
    warn(
        "the noise falls as the image gets brighter, which no count of electrons does: the image "
        "may be inverted, "
        "saturated, or its grey levels bent by a gamma");
  if (e.off_line_share > 0)
    warn(fmt::format(
        "the line is at or below the least variance at {:.2g} % of the image, which is darker than "
        "{:.4g}: there the variance bends to {:.3g} and stays",
        100 * e.off_line_share, (2 * e.noise.least_variance - e.noise.intercept) / e.noise.slope,
        e.noise.least_variance));
  if (e.correlation_squares > 1.1)
    warn(fmt::format(
        "the noise of neighbouring pixels is correlated ({:.2f} along rows, {:.2f} across): the "
        "image was "
        "filtered, compressed or resampled. A likelihood that takes pixels as independent counts "
        "{:.2g} times too many",
        e.correlation_x, e.correlation_y, e.correlation_sum));
  if (e.quantum > 0 && typical < e.quantum * e.quantum)
    warn(
        fmt::format("the noise (standard deviation {:.2g}) is finer than the steps of the grey "
                    "levels ({:g}): it is "
                    "not normal. Use an image of more bits, if there is one",
                    std::sqrt(typical), e.quantum));
  if (e.black + e.white > 0)
    warn(
        fmt::format("{} pixels are saturated (black {}, white {}): what is there of them is not "
                    "noise, and they are "
                    "left out",
                    e.black + e.white, e.black, e.white));
  const bool bends = std::fabs(e.curvature_z) > 4 && e.bend > 0.1;
  if (bends)
    warn(
        fmt::format("the variances do not lie on a line: a parabola is up to {:.0f} % off it (z = "
                    "{:.1f}). A gamma or "
                    "another processing of the grey levels is likely",
                    100 * e.bend, e.curvature_z));
  if (!bends && e.degrees > 1 && e.p < 1e-3)
    warn(
        fmt::format("the variances scatter {:.2g} times as much about the line as their own errors "
                    "say: not all "
                    "places are flat, or the noise is uneven; standard errors are enlarged by it",
                    std::sqrt(e.dispersion)));
}

}  // namespace surf
