// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/noise_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surf/core/error.h"

namespace surf {
namespace {

void require_mask(const Grid<double>& values, const Mask& valid) {
  if (valid.empty() || (valid.width() == values.width() && valid.height() == values.height()))
    return;
  throw InvalidInput("noise", "the mask has another size than the residuals",
                     "Give a mask of the same size");
}

struct Moments {
  std::size_t n = 0;
  double mean = 0, m2 = 0, m3 = 0, m4 = 0;  // central, divided by n
};

Moments moments(const Grid<double>& values, const Mask& valid) {
  Moments m;
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (valid.includes(i)) visit(values.data()[i]);
  };
  each([&](double v) {
    if (!std::isfinite(v))
      throw InvalidInput("noise", "a residual is not finite", "Mark it as invalid");
    m.mean += v, ++m.n;
  });
  const double n = static_cast<double>(std::max<std::size_t>(m.n, 1));
  m.mean /= n;
  each([&](double v) {
    const double d = v - m.mean, d2 = d * d;
    m.m2 += d2 / n, m.m3 += d2 * d / n, m.m4 += d2 * d2 / n;
  });
  return m;
}

/// The sum of products of values that are dx columns and dy rows apart, relative to `mean`, and the
/// number of pairs.
std::pair<double, std::size_t> products(const Grid<double>& values, const Mask& valid, int dx,
                                        int dy, double mean) {
  double total = 0;
  std::size_t pairs = 0;
  for (int y = dy; y < values.height(); ++y) {
    double row = 0;
    for (int x = dx; x < values.width(); ++x) {
      if (!valid.empty() && !(valid(x, y) && valid(x - dx, y - dy))) continue;
      row += (values(x, y) - mean) * (values(x - dx, y - dy) - mean);
      ++pairs;
    }
    total += row;
  }
  return {total, pairs};
}

std::vector<LagCorrelation> correlations(const Grid<double>& values, const Mask& valid,
                                         const Moments& m, int lags, bool along) {
  std::vector<LagCorrelation> out;
  for (int lag = 1; lag <= std::min(lags, (along ? values.width() : values.height()) - 1); ++lag) {
    const auto [sum, pairs] = products(values, valid, along ? lag : 0, along ? 0 : lag, m.mean);
    if (pairs == 0) continue;
    const double r = sum / (static_cast<double>(pairs) * m.m2);
    out.push_back({lag, r, r * std::sqrt(static_cast<double>(pairs))});
  }
  return out;
}

double sum_of_squares(const std::vector<LagCorrelation>& lags) {
  double sum = 0;
  for (const LagCorrelation& l : lags) sum += l.z * l.z;
  return sum;
}

}  // namespace

double chi_squared_tail(double x, int degrees) {
  if (!(x > 0)) return 1;
  const double half = x / 2;
  // Q(d + 2) = Q(d) + (x / 2)^(d / 2) exp(-x / 2) / Gamma(d / 2 + 1).
  double tail = degrees % 2 ? std::erfc(std::sqrt(half)) : std::exp(-half);
  for (int d = degrees % 2 ? 1 : 2; d < degrees; d += 2)
    tail += std::exp(0.5 * d * std::log(half) - half - std::lgamma(0.5 * d + 1));
  return std::min(tail, 1.0);
}

std::vector<double> autocovariance(const Grid<double>& residual, int lags, const Mask& valid) {
  require_mask(residual, valid);
  std::vector<double> out;
  for (int lag = 0; lag <= lags; ++lag) {
    const auto [sum, pairs] = products(residual, valid, lag, 0, 0);
    out.push_back(pairs ? sum / static_cast<double>(pairs) : 0);
  }
  return out;
}

NoiseCheck check_noise(const Grid<double>& whitened, const Mask& valid,
                       const NoiseCheckOptions& options) {
  require_mask(whitened, valid);
  if (options.lags < 1 || options.fitted_parameters < 0)
    throw UsageError(
        "lags",
        fmt::format("{} lags, {} fitted parameters", options.lags, options.fitted_parameters),
        "Give at least one lag and no negative number");
  const Moments m = moments(whitened, valid);
  if (m.n < 16 || !(m.m2 > 0))
    throw InvalidInput(
        "noise", m.n < 16 ? fmt::format("{} samples take part", m.n) : "all residuals are equal",
        "Use at least 16 samples of an image with noise");
  NoiseCheck c;
  c.samples = m.n;
  c.mean = m.mean;
  c.standard_deviation = std::sqrt(m.m2);
  c.along = correlations(whitened, valid, m, options.lags, true);
  c.across = correlations(whitened, valid, m, options.lags, false);
  c.along_q = sum_of_squares(c.along);
  c.across_q = sum_of_squares(c.across);
  const int free = static_cast<int>(c.along.size()) - options.fitted_parameters;
  if (free > 0) c.along_p = chi_squared_tail(c.along_q, free);
  if (!c.across.empty())
    c.across_p = chi_squared_tail(c.across_q, static_cast<int>(c.across.size()));
  const double n = static_cast<double>(m.n);
  c.skewness = m.m3 / std::pow(m.m2, 1.5);
  c.excess_kurtosis = m.m4 / (m.m2 * m.m2) - 3;
  const double variance_of_skewness = 6 * (n - 2) / ((n + 1) * (n + 3));
  const double mean_of_kurtosis = -6 / (n + 1);
  const double variance_of_kurtosis =
      24 * n * (n - 2) * (n - 3) / ((n + 1) * (n + 1) * (n + 3) * (n + 5));
  c.jarque_bera = c.skewness * c.skewness / variance_of_skewness +
                  std::pow(c.excess_kurtosis - mean_of_kurtosis, 2) / variance_of_kurtosis;
  c.normal_p = chi_squared_tail(c.jarque_bera, 2);
  return c;
}

}  // namespace surf
