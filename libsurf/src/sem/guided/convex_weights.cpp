// SPDX-License-Identifier: GPL-3.0-or-later
#include "convex_weights.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace surf::guided {
namespace {

constexpr int most_steps = 400;
constexpr double enough = 1e-5;  // the largest change of a weight in a step

/// Moves a point to the nearest one with all coordinates >= 0 and sum 1 (Held, Wolfe and Crowder
/// 1974, doi:10.1007/BF01580223).
void project(std::vector<double>& point, std::vector<double>& sorted) {
  sorted = point;
  std::ranges::sort(sorted, std::greater<>());
  double sum = 0, shift = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    sum += sorted[i];
    const double next = (sum - 1) / static_cast<double>(i + 1);
    if (sorted[i] > next) shift = next;
  }
  for (double& x : point) x = std::max(x - shift, 0.0);
}

}  // namespace

std::vector<double> convex_weights(std::span<const double> matrix, std::span<const double> linear) {
  const std::size_t n = linear.size();
  double bound = 0;  // of the largest eigenvalue: the largest sum of magnitudes in a row
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += std::abs(matrix[i * n + j]);
    bound = std::max(bound, sum);
  }
  std::vector<double> weights(n, 1.0 / static_cast<double>(n)), ahead = weights, before, sorted;
  if (!(bound > 0)) {
    // Without curvature all the weight is where the linear part is least.
    std::ranges::fill(weights, 0.0);
    weights[static_cast<std::size_t>(std::ranges::min_element(linear) - linear.begin())] = 1;
    return weights;
  }
  for (int step = 0; step < most_steps; ++step) {
    before = weights;
    for (std::size_t i = 0; i < n; ++i) {
      double gradient = linear[i];
      for (std::size_t j = 0; j < n; ++j) gradient += matrix[i * n + j] * ahead[j];
      weights[i] = ahead[i] - gradient / bound;
    }
    project(weights, sorted);
    double change = 0;
    const double momentum = step / (step + 3.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double moved = weights[i] - before[i];
      change = std::max(change, std::abs(moved));
      ahead[i] = weights[i] + momentum * moved;
    }
    if (change < enough) break;
  }
  return weights;
}

}  // namespace surf::guided
