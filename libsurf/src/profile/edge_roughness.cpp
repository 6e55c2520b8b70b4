// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/edge_roughness.h"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <vector>

#include "surf/core/error.h"

namespace surf {
namespace {

constexpr std::size_t fewest_places = 16;
constexpr int aliases = 3;
// Neighbouring frequencies of a Hann window are not independent: they count as half as many.
constexpr double independent_share = 0.51;
constexpr double usual_hurst = 0.6, hurst_deviation = 0.2;
constexpr double worth_nats = 3;  // of what is more than noise

enum { log_sigma, log_correlation, hurst, log_noise, numbers };
using Numbers = std::array<double, numbers>;

EdgeRoughness roughness_of(const Numbers& n) {
  EdgeRoughness r;
  r.sigma_nm = std::exp(n[log_sigma]);
  r.correlation_nm = std::exp(n[log_correlation]);
  r.hurst = n[hurst];
  r.noise_nm = std::exp(n[log_noise]);
  return r;
}

/// Minus the logarithm of Whittle's likelihood, and of a prior of the exponent, which short edges
/// do not tell.
struct Whittle {
  const EdgeSpectrum& spectrum;
  double weight, distance_nm;

  double operator()(const EdgeRoughness& r) const {
    double sum = 0;
    for (std::size_t i = 0; i < spectrum.frequency_per_nm.size(); ++i) {
      const double expected = roughness_density(r, spectrum.frequency_per_nm[i], distance_nm);
      sum += std::log(expected) + spectrum.density_nm3[i] / expected;
    }
    return weight * sum + 0.5 * std::pow((r.hurst - usual_hurst) / hurst_deviation, 2);
  }
};

void remove_line(std::vector<double>& y) {
  const auto n = static_cast<double>(y.size());
  double mean = 0, slope = 0, spread = 0;
  for (const double v : y) mean += v / n;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double x = static_cast<double>(i) - 0.5 * (n - 1);
    slope += x * y[i], spread += x * x;
  }
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] -= mean + slope / spread * (static_cast<double>(i) - 0.5 * (n - 1));
}

/// The standard error of the logarithm of sigma, by the curvature of the likelihood. Numbers at
/// their limits are taken as known.
double error_of_log_sigma(const Whittle& whittle, const Numbers& at, const Numbers& low,
                          const Numbers& high) {
  constexpr double step = 0.02;
  std::vector<std::size_t> free{log_sigma};
  for (std::size_t k = log_sigma + 1; k < numbers; ++k)
    if (at[k] - low[k] > 2 * step && high[k] - at[k] > 2 * step) free.push_back(k);
  const std::size_t n = free.size();
  std::vector<std::vector<double>> h(n, std::vector<double>(n, 0));
  const auto value = [&](std::size_t i, double by_i, std::size_t k, double by_k) {
    Numbers moved = at;
    moved[free[i]] += by_i;
    moved[free[k]] += by_k;
    return whittle(roughness_of(moved));
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      h[i][k] = (value(i, step, k, step) - value(i, step, k, -step) - value(i, -step, k, step) +
                 value(i, -step, k, -step)) /
                (4 * step * step);
  const double alone = h[0][0];
  // Eliminating all but sigma leaves the inverse of its variance.
  for (std::size_t k = n - 1; k > 0; --k) {
    if (!(h[k][k] > 1e-6)) continue;
    for (std::size_t i = 0; i < k; ++i)
      for (std::size_t j = 0; j < k; ++j) h[i][j] -= h[i][k] * h[k][j] / h[k][k];
  }
  const double information = h[0][0] > 0.01 * alone ? h[0][0] : 0.01 * alone;
  return information > 0 ? std::min(1.0, 1 / std::sqrt(information)) : 1;
}

}  // namespace

EdgeSpectrum edge_spectrum(const std::vector<std::vector<double>>& edges, double distance_nm) {
  if (edges.empty() || edges.front().size() < fewest_places)
    throw InvalidInput("edges", fmt::format("fewer than {} places have no spectrum", fewest_places),
                       "Give longer edges");
  const std::size_t n = edges.front().size();
  EdgeSpectrum out;
  const std::size_t count = (n - 1) / 2;
  out.density_nm3.assign(count, 0);
  for (std::size_t j = 1; j <= count; ++j)
    out.frequency_per_nm.push_back(static_cast<double>(j) / (static_cast<double>(n) * distance_nm));
  std::vector<double> window(n);
  double power = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double s =
        std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    window[i] = s * s;
    power += window[i] * window[i];
  }
  for (std::vector<double> edge : edges) {
    if (edge.size() != n)
      throw InvalidInput("edges", "they have different lengths", "Give edges of the same rows");
    if (!std::ranges::all_of(edge, [](double v) { return std::isfinite(v); }))
      throw InvalidInput("edges", "a place is not finite", "Leave out rows without an edge");
    remove_line(edge);
    for (std::size_t j = 1; j <= count; ++j) {
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < n; ++i)
        sum += window[i] * edge[i] *
               std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i * j % n) /
                                   static_cast<double>(n));
      out.density_nm3[j - 1] +=
          std::norm(sum) * distance_nm / (power * static_cast<double>(edges.size()));
    }
  }
  return out;
}

double roughness_density(const EdgeRoughness& r, double frequency_per_nm, double distance_nm) {
  const double size = r.sigma_nm * r.sigma_nm * r.correlation_nm * 2 * std::sqrt(std::numbers::pi) *
                      std::exp(std::lgamma(r.hurst + 0.5) - std::lgamma(r.hurst));
  double sum = r.noise_nm * r.noise_nm * distance_nm;
  for (int k = -aliases; k <= aliases; ++k) {
    const double x = 2 * std::numbers::pi * (frequency_per_nm + k / distance_nm) * r.correlation_nm;
    sum += size / std::pow(1 + x * x, r.hurst + 0.5);
  }
  return sum;
}

EdgeRoughness fit_roughness(const EdgeSpectrum& spectrum, int edges, double distance_nm) {
  if (spectrum.frequency_per_nm.size() < fewest_places / 2 - 1)
    throw InvalidInput("spectrum", "it has too few frequencies", "Give longer edges");
  const double first = spectrum.frequency_per_nm.front();
  double variance = 0, least = HUGE_VAL;
  for (const double d : spectrum.density_nm3) variance += 2 * first * d;
  // The quarter of highest frequencies is mostly noise.
  double tail = 0;
  const std::size_t from = spectrum.density_nm3.size() * 3 / 4;
  for (std::size_t i = from; i < spectrum.density_nm3.size(); ++i)
    tail += spectrum.density_nm3[i] / static_cast<double>(spectrum.density_nm3.size() - from);
  const double noise = std::sqrt(std::max(tail / distance_nm, 1e-12 * variance + 1e-24)),
               all = std::sqrt(std::max(variance, 1e-24));
  Whittle whittle{spectrum, edges * independent_share, distance_nm};
  const Numbers low{std::log(1e-3 * all), std::log(0.5 * distance_nm), 0.1, std::log(1e-2 * noise)},
      high{std::log(10 * all), std::log(0.5 / first), 1, std::log(2 * all + noise)};
  Numbers best{};
  for (const double length : {3 * distance_nm, 0.05 / first}) {
    Numbers at{std::log(0.8 * all), std::log(length), 0.6, std::log(0.9 * noise)};
    for (std::size_t k = 0; k < numbers; ++k) at[k] = std::clamp(at[k], low[k], high[k]);
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(
        nlopt_create(NLOPT_LN_SBPLX, numbers), nlopt_destroy);
    nlopt_set_min_objective(
        optimiser.get(),
        [](unsigned, const double* x, double*, void* self) {
          Numbers n;
          std::copy_n(x, numbers, n.begin());
          return (*static_cast<Whittle*>(self))(roughness_of(n));
        },
        &whittle);
    nlopt_set_lower_bounds(optimiser.get(), low.data());
    nlopt_set_upper_bounds(optimiser.get(), high.data());
    nlopt_set_maxeval(optimiser.get(), 3000);
    nlopt_set_ftol_abs(optimiser.get(), 1e-4);
    double value = 0;
    nlopt_optimize(optimiser.get(), at.data(), &value);
    if (value < least) least = value, best = at;
  }
  EdgeRoughness r = roughness_of(best);
  r.biased_sigma_nm = all;
  r.sigma_error_nm = r.sigma_nm * error_of_log_sigma(whittle, best, low, high);
  EdgeRoughness none;
  none.sigma_nm = 1e-9;
  none.correlation_nm = distance_nm;
  none.noise_nm = all;
  r.found = whittle(none) - least > worth_nats;
  return r;
}

}  // namespace surf
