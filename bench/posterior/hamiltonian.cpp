// SPDX-License-Identifier: GPL-3.0-or-later
#include "hamiltonian.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "afm/normal_numbers.h"

namespace surf::bench {
namespace {

/// Dual averaging of the logarithm of the step (Hoffman and Gelman 2014, section 3.2), with the
/// constants that they recommend.
class StepSize {
 public:
  StepSize(double first, double target)
      : log_(std::log(first)), shrink_(log_ + std::log(10)), target_(target) {}
  void learn(double acceptance) {
    ++count_;
    const double t = count_;
    error_ += (target_ - acceptance - error_) / (t + 10);
    log_ = shrink_ - std::sqrt(t) / 0.05 * error_;
    const double weight = std::pow(t, -0.75);
    mean_ = weight * log_ + (1 - weight) * mean_;
  }
  double now() const { return std::exp(log_); }
  double settled() const { return std::exp(mean_); }

 private:
  double log_, shrink_, target_, error_ = 0, mean_ = 0;
  int count_ = 0;
};

}  // namespace

Chain hamiltonian(const Energy& energy, int unknowns,
                  const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& record,
                  const HamiltonianOptions& o) {
  NormalNumbers normal(o.seed, 100 + o.chain);
  RandomStream random(o.seed, 200 + o.chain, 0);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(unknowns), gradient(unknowns);
  double here = energy(at, gradient);
  StepSize size(0.1, o.acceptance);
  Chain chain;
  chain.draws.resize(record(at).size(), o.draws);
  for (int i = 0; i < o.warm_up + o.draws; ++i) {
    if (i % 50 == 0) fmt::print(stderr, "chain {}, draw {}\n", o.chain, i);
    const bool warming = i < o.warm_up;
    const double step = (warming ? size.now() : size.settled());
    const double length = o.length * (0.7 + 0.6 * random.uniform());
    const int steps = std::clamp(static_cast<int>(std::lround(length / step)), 1, o.most_steps);
    Eigen::VectorXd momentum(unknowns), next = at, slope = gradient;
    for (double& m : momentum) m = normal();
    const double before = here + 0.5 * momentum.squaredNorm();
    double there = here;
    for (int k = 0; k < steps; ++k) {
      momentum -= 0.5 * step * slope;
      next += step * momentum;
      there = energy(next, slope);
      momentum -= 0.5 * step * slope;
    }
    const double rise = there + 0.5 * momentum.squaredNorm() - before;
    const double acceptance = std::isfinite(rise) ? std::min(1.0, std::exp(-rise)) : 0;
    if (random.uniform() < acceptance) {
      at = next;
      gradient = slope;
      here = there;
    }
    if (warming) {
      size.learn(acceptance);
      continue;
    }
    chain.acceptance += acceptance / o.draws;
    chain.draws.col(i - o.warm_up) = record(at);
  }
  chain.step = size.settled();
  return chain;
}

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
