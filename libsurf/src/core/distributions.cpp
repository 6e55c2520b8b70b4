// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/distributions.h"

#include <algorithm>
#include <cmath>

namespace surf {
namespace {

// Below it the simple methods are as quick, and transformed rejection is not valid.
constexpr double few = 10;

/// ln k!. Stirling's series is used for k >= 10; its error is below 1e-12.
double log_factorial(std::int64_t k) {
  if (k < 10) {
    double product = 1;
    for (std::int64_t i = 2; i <= k; ++i) product *= static_cast<double>(i);
    return std::log(product);
  }
  constexpr double half_log_of_two_pi = 0.91893853320467274178;
  const double x = static_cast<double>(k) + 1, y = 1 / (x * x);
  return (x - 0.5) * std::log(x) - x + half_log_of_two_pi +
         (1.0 / 12 - y * (1.0 / 360 - y * (1.0 / 1260 - y / 1680))) / x;
}

std::int64_t poisson_by_product(double mean, RandomStream& random) {
  const double least = std::exp(-mean);
  std::int64_t count = 0;
  for (double product = random.uniform(); product > least; product *= random.uniform()) ++count;
  return count;
}

std::int64_t poisson_by_rejection(double mean, RandomStream& random) {
  const double log_mean = std::log(mean);
  const double b = 0.931 + 2.53 * std::sqrt(mean), a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4), most = 0.9277 - 3.6224 / (b - 2);
  for (;;) {
    const double u = random.uniform() - 0.5, v = random.uniform();
    const double us = 0.5 - std::fabs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= most) return static_cast<std::int64_t>(k);
    if (k < 0 || (us < 0.013 && v > us)) continue;
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <=
        k * log_mean - mean - log_factorial(static_cast<std::int64_t>(k)))
      return static_cast<std::int64_t>(k);
  }
}

/// The waiting time until each success is geometrically distributed.
std::int64_t binomial_by_waiting(std::int64_t trials, double probability, RandomStream& random) {
  const double log_failure = std::log1p(-probability);
  std::int64_t successes = 0;
  for (double used = 0;; ++successes) {
    used += std::floor(std::log(random.uniform()) / log_failure) + 1;
    if (used > static_cast<double>(trials)) return successes;
  }
}

std::int64_t binomial_by_rejection(std::int64_t trials, double p, RandomStream& random) {
  const double n = static_cast<double>(trials), q = 1 - p, spread = std::sqrt(n * p * q);
  const double b = 1.15 + 2.53 * spread, a = -0.0873 + 0.0248 * b + 0.01 * p, c = n * p + 0.5;
  const double most = 0.92 - 4.2 / b, alpha = (2.83 + 5.1 / b) * spread, log_odds = std::log(p / q);
  const double mode = std::floor((n + 1) * p);
  const double at_mode = log_factorial(static_cast<std::int64_t>(mode)) +
                         log_factorial(trials - static_cast<std::int64_t>(mode));
  for (;;) {
    const double u = random.uniform() - 0.5, v = random.uniform();
    const double us = 0.5 - std::fabs(u);
    const double k = std::floor((2 * a / us + b) * u + c);
    if (k < 0 || k > n) continue;
    if (us >= 0.07 && v <= most) return static_cast<std::int64_t>(k);
    const auto count = static_cast<std::int64_t>(k);
    if (std::log(v * alpha / (a / (us * us) + b)) <=
        at_mode - log_factorial(count) - log_factorial(trials - count) + (k - mode) * log_odds)
      return count;
  }
}

}  // namespace

std::int64_t poisson(double mean, RandomStream& random) {
  if (!(mean > 0)) return 0;
  return mean < few ? poisson_by_product(mean, random) : poisson_by_rejection(mean, random);
}

std::int64_t binomial(std::int64_t trials, double probability, RandomStream& random) {
  if (trials <= 0 || !(probability > 0)) return 0;
  if (probability >= 1) return trials;
  if (probability > 0.5) return trials - binomial(trials, 1 - probability, random);
  if (static_cast<double>(trials) * probability < few)
    return binomial_by_waiting(trials, probability, random);
  return binomial_by_rejection(trials, probability, random);
}

}  // namespace surf
