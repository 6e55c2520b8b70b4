// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain.h"

#include <cmath>

namespace surf::bench {

Mixing mixing_of(const std::vector<Chain>& chains, Eigen::Index number) {
  std::vector<Eigen::VectorXd> parts;
  const Eigen::Index n = chains.front().draws.cols() / 2;
  for (const Chain& c : chains) {
    parts.emplace_back(c.draws.row(number).head(n).transpose());
    parts.emplace_back(c.draws.row(number).tail(n).transpose());
  }
  const auto m = static_cast<double>(parts.size()), length = static_cast<double>(n);
  double within = 0, mean = 0, between = 0;
  for (Eigen::VectorXd& p : parts) mean += p.mean() / m;
  for (Eigen::VectorXd& p : parts) {
    const double own = p.mean();
    between += length * (own - mean) * (own - mean) / (m - 1);
    p.array() -= own;
    within += p.squaredNorm() / (length - 1) / m;
  }
  const double variance = (length - 1) / length * within + between / length;
  const auto correlation = [&](Eigen::Index lag) {
    double sum = 0;
    for (const Eigen::VectorXd& p : parts) sum += p.head(n - lag).dot(p.tail(n - lag)) / length / m;
    return 1 - (within - sum) / variance;
  };
  double sum = 0;
  for (Eigen::Index lag = 1; lag + 1 < n; lag += 2) {
    const double pair = correlation(lag) + correlation(lag + 1);
    if (pair < 0) break;
    sum += pair;
  }
  return {std::sqrt(variance / within), m * length / (1 + 2 * sum)};
}

}  // namespace surf::bench
