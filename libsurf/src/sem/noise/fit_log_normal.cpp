// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "sem/minimise/minimise.h"
#include "surf/core/error.h"
#include "surf/sem/count_distribution.h"

namespace surf {
namespace {

/// The standard normal number that corresponds to x, its density, and the derivatives of its
/// distribution function by the median, the logarithm of the scale, and the logarithm of the shape.
struct Edge {
  double z = 0;
  double by[3] = {0, 0, 0};
};

Edge edge_at(const double* parameters, double x) {
  const double scale = std::exp(parameters[1]), shape = std::exp(parameters[2]);
  const double y = (x - parameters[0]) / scale, inside = 1 + shape * y;
  Edge e;
  if (!(inside > 0)) {
    e.z = -std::numeric_limits<double>::infinity();
    return e;
  }
  e.z = std::log1p(shape * y) / shape;
  const double density = std::exp(-0.5 * e.z * e.z) / std::sqrt(2 * std::numbers::pi);
  e.by[0] = -density / (inside * scale);
  e.by[1] = -density * y / inside;
  e.by[2] = density * (y / inside - e.z);
  return e;
}

/// The mean of -log P, which is of order 1.
class Likelihood final : public solvers::SmoothFunction {
 public:
  Likelihood(const CountHistogram& counts, double trials) : counts_(counts), trials_(trials) {}
  int size() const override { return 3; }

  bool evaluate(const double* p, double* cost, double* gradient) const override {
    if (!(std::fabs(p[1]) < 300 && std::fabs(p[2]) < 300)) return false;
    const LogNormalCounts d{p[0], std::exp(p[1]), std::exp(p[2])};
    *cost = 0;
    if (gradient) std::fill(gradient, gradient + 3, 0.0);
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      if (counts_[k] == 0) continue;
      const double probability = d.probability(static_cast<std::int64_t>(k));
      if (!(probability > 0))
        return false;  // outside the support: the line search shortens its step
      const double share = static_cast<double>(counts_[k]) / trials_, x = static_cast<double>(k);
      *cost -= share * std::log(probability);
      if (!gradient) continue;
      const Edge upper = edge_at(p, x + 0.5), lower = k > 0 ? edge_at(p, x - 0.5) : Edge{};
      for (int i = 0; i < 3; ++i) gradient[i] -= share * (upper.by[i] - lower.by[i]) / probability;
    }
    return std::isfinite(*cost);
  }

 private:
  const CountHistogram& counts_;
  double trials_;
};

/// The shape with the given skewness, which is shape (3 + shape^2 ...) for small shapes.
double shape_of(double skewness) {
  double low = 1e-3, high = 2;
  for (int i = 0; i < 60; ++i) {
    const double shape = 0.5 * (low + high), e = std::exp(shape * shape);
    ((e + 2) * std::sqrt(e - 1) < skewness ? low : high) = shape;
  }
  return high;
}

}  // namespace

LogNormalCounts fit_log_normal(const CountHistogram& counts) {
  const CountMoments m = moments(counts);
  if (!(m.variance > 0))
    throw InvalidInput("counts", "all trials gave the same count", "Use more primaries in a trial");
  const Likelihood likelihood(counts, static_cast<double>(m.trials));
  solvers::MinimiseOptions how;
  how.search = solvers::Search::bfgs;
  how.most_iterations = 500;
  how.function_tolerance = 0;
  how.parameter_tolerance = 0;
  how.gradient_tolerance = 1e-9;
  // Starts from several shapes, because with few counts there may be several optima.
  double best_cost = std::numeric_limits<double>::infinity();
  LogNormalCounts best{m.mean, std::sqrt(m.variance), 0};
  for (const double shape : {shape_of(m.skewness), 0.05, 0.3, 1.0}) {
    const double variance_per_scale =
        std::expm1(shape * shape) * std::exp(shape * shape) / (shape * shape);
    const double scale = std::sqrt(m.variance / variance_per_scale);
    const double median = m.mean - scale * std::expm1(0.5 * shape * shape) / shape;
    double p[3] = {median, std::log(scale), std::log(shape)};
    double cost = 0;
    if (!likelihood.evaluate(p, &cost, nullptr)) continue;
    const solvers::Minimised done = solvers::minimise(likelihood, std::span<double>(p), how);
    const bool usable =
        done.ended == solvers::Ended::settled || done.ended == solvers::Ended::iterations;
    if (!usable || !(done.value < best_cost)) continue;
    best_cost = done.value;
    best = {p[0], std::exp(p[1]), std::exp(p[2])};
  }
  return best;
}

}  // namespace surf
