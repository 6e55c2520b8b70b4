// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaled_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace surf::bench {
namespace {

constexpr int bins = 10;

/// The mean of all numbers, and its error by the scatter of groups.
struct Mean {
  double value = 0, error = 0;
};
Mean mean_of(const std::map<int, std::vector<OneError>>& groups,
             double (*number)(const OneError&)) {
  double sum = 0, count = 0, squares = 0;
  for (const auto& [fit, errors] : groups)
    for (const OneError& e : errors) sum += number(e), count += 1;
  const double mean = sum / count;
  for (const auto& [fit, errors] : groups) {
    double off = 0;
    for (const OneError& e : errors) off += number(e) - mean;
    squares += off * off;
  }
  const auto n = static_cast<double>(groups.size());
  return {mean, std::sqrt(squares * n / std::max(n - 1, 1.0)) / count};
}

/// The probability of a larger chi-squared with an odd number of degrees of freedom.
double chi_squared_above(double x, int degrees) {
  const double root = std::sqrt(x);
  double term = root, sum = 0;
  for (int r = 1; r <= (degrees - 1) / 2; ++r) {
    sum += term;
    term *= x / (2 * r + 1);
  }
  return std::erfc(root / std::numbers::sqrt2) +
         std::sqrt(2 / std::numbers::pi) * std::exp(-x / 2) * sum;
}

}  // namespace

void ScaledErrors::add(const std::string& quantity, int fit, const std::vector<OneError>& errors) {
  if (errors.empty()) return;
  std::vector<OneError>& own = errors_[quantity][fit];
  own.insert(own.end(), errors.begin(), errors.end());
}

void ScaledErrors::print_coverage(const std::string& quantity) const {
  const auto found = errors_.find(quantity);
  if (found == errors_.end()) return;
  const auto& groups = found->second;
  const Mean one = mean_of(groups,
                           [](const OneError&e) { return std::abs(e.scaled()) <= 1 ? 100.0 : 0; }),
             two = mean_of(groups,
                           [](const OneError&e) { return std::abs(e.scaled()) <= 2 ? 100.0 : 0; }),
             mean = mean_of(groups, [](const OneError&e) { return e.scaled(); }),
             square = mean_of(groups, [](const OneError&e) { return e.scaled() * e.scaled(); }),
             off = mean_of(groups, [](const OneError&e) { return e.off * e.off; }),
             stated = mean_of(groups, [](const OneError&e) { return e.deviation * e.deviation; });
  const double rms = std::sqrt(square.value);
  fmt::print(
      "  {:32} {:5.1f} +- {:3.1f}   {:5.1f} +- {:3.1f}   {:6.2f} +- {:4.2f}   {:5.2f} +- {:4.2f}   "
      "{:8.2g} {:8.2g}\n",
      quantity, one.value, one.error, two.value, two.error, mean.value, mean.error, rms,
      square.error / (2 * rms), std::sqrt(off.value), std::sqrt(stated.value));
}

void ScaledErrors::print_places(const std::string& quantity) const {
  const auto found = errors_.find(quantity);
  if (found == errors_.end()) return;
  std::array<int, bins> counts{};
  int total = 0;
  for (const auto& [fit, errors] : found->second)
    for (const OneError& e : errors) {
      const double place = 0.5 * std::erfc(e.scaled() / std::numbers::sqrt2);
      ++counts[static_cast<std::size_t>(std::clamp(static_cast<int>(bins * place), 0, bins - 1))];
      ++total;
    }
  double chi_squared = 0;
  const double expected = total / static_cast<double>(bins);
  fmt::print("  {:32}", quantity);
  for (const int c : counts) {
    chi_squared += (c - expected) * (c - expected) / expected;
    fmt::print(" {:3}", c);
  }
  fmt::print("   {:5.1f}, p = {:.1g}\n", chi_squared, chi_squared_above(chi_squared, bins - 1));
}

}  // namespace surf::bench
