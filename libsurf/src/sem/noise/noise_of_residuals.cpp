// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/noise_of_residuals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "variance_line.h"

namespace surf {
namespace {

constexpr std::size_t most_bins = 30, least_in_bin = 100;
constexpr double cut = 3.5, least_share = 0.01;
// Standard deviation over the median of absolute values, for normal numbers.
constexpr double of_median = 1.4826;
// Degrees of freedom of a squared median, per value: 0.37 for normal numbers, times the share that
// remains because neighbouring second differences are correlated (6^2 / (6^2 + 2 (4^2 + 1)),
// squared correlations).
constexpr double freedom = 0.37 * 36 / (36 + 2 * 17);

struct Difference {
  double mean = 0, value = 0;
};

double middle(std::vector<double>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, at);
  return *at;
}

std::vector<Difference> second_differences(const Grid<double>& real, const Grid<double>& mean,
                                           const Mask& used) {
  std::vector<Difference> out;
  for (int y = 0; y < real.height(); ++y)
    for (int x = 1; x + 1 < real.width(); ++x) {
      const auto residual = [&](int column) { return real(column, y) - mean(column, y); };
      if (!used.empty() && !(used(x - 1, y) && used(x, y) && used(x + 1, y))) continue;
      const double d = (residual(x - 1) - 2 * residual(x) + residual(x + 1)) / std::sqrt(6.0);
      if (!std::isfinite(d))
        throw InvalidInput("SEM noise", "a pixel that counts is not finite",
                           "Leave it out by the mask");
      out.push_back({mean(x, y), std::fabs(d)});
    }
  return out;
}

}  // namespace

SemNoise noise_of_residuals(const Grid<double>& real, const Grid<double>& mean, const Mask& used) {
  const auto differs = [&](const auto& grid) {
    return grid.width() != real.width() || grid.height() != real.height();
  };
  if (differs(mean) || (!used.empty() && differs(used)))
    throw InvalidInput("SEM noise", "the image, its mean and the mask differ in size",
                       "Give them pixel on pixel");
  std::vector<Difference> all = second_differences(real, mean, used);
  const std::size_t n = all.size();
  if (n < least_in_bin)
    throw InvalidInput("SEM noise", fmt::format("{} pixels count", n),
                       "Use 100 or more, with neighbours");
  std::ranges::stable_sort(all, {}, &Difference::mean);
  const std::size_t bins = std::clamp<std::size_t>(n / least_in_bin, 1, most_bins);
  std::vector<VariancePoint> points;
  std::vector<double> variances;
  for (std::size_t b = 0; b < bins; ++b) {
    VariancePoint p;
    std::vector<double> values;
    for (std::size_t i = b * n / bins; i < (b + 1) * n / bins; ++i) {
      p.mean += all[i].mean;
      values.push_back(all[i].value);
    }
    p.mean /= static_cast<double>(values.size());
    p.freedom = freedom * static_cast<double>(values.size());
    const double deviation = of_median * middle(values);
    p.variance = deviation * deviation;
    points.push_back(p);
    variances.push_back(p.variance);
  }
  const double least = least_share * middle(variances);
  if (!(least > 0))
    throw InvalidInput("SEM noise", "half of what the model leaves is 0: there is no noise",
                       "Give a real image");
  VarianceLine line = fit_variance_line(points, {false, least, cut});
  const bool known = bins > 3 && line.covariance[0] > 0 &&
                     std::fabs(line.slope) > 2 * std::sqrt(line.covariance[0]);
  if (!known) line = fit_variance_line(points, {true, least, cut});
  return {line.slope, line.intercept, least};
}

}  // namespace surf
