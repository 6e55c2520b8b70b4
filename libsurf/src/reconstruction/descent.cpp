// SPDX-License-Identifier: GPL-3.0-or-later
#include "descent.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "damped_steps.h"
#include "gaussian_basis.h"
#include "sem/minimise/minimise.h"
#include "surf/core/error.h"

namespace surf::reconstruction {
namespace {

class Problem final : public solvers::SmoothFunction {
 public:
  Problem(const Objective& objective, const Unknowns& base, const GaussianBasis& basis,
          const Watch& watch)
      : objective_(objective), base_(base), basis_(basis), watch_(watch) {}

  bool evaluate(const double* coefficients, double* cost, double* gradient) const override {
    watch_.check();
    ++evaluations;
    const Unknowns at = surface_of(coefficients);
    const Objective::State state = objective_.evaluate(at);
    *cost = state.value();
    if (gradient) {
      const Grid<double> g = basis_.transpose(objective_.gradient(at, state).z_nm);
      std::copy(g.data().begin(), g.data().end(), gradient);
    }
    return std::isfinite(*cost);
  }
  int size() const override { return static_cast<int>(base_.z_nm.size()); }

  Unknowns surface_of(const double* coefficients) const {
    Grid<double> c(base_.z_nm.width(), base_.z_nm.height());
    std::copy(coefficients, coefficients + c.size(), c.data().begin());
    Unknowns at = base_;
    const Grid<double> h = basis_.sum(c);
    for (std::size_t i = 0; i < h.size(); ++i) at.z_nm.data()[i] += h.data()[i];
    return at;
  }

  mutable int evaluations = 0;

 private:
  const Objective& objective_;
  const Unknowns& base_;
  const GaussianBasis& basis_;
  const Watch& watch_;
};

/// Ends the descent when three iterations in a row lower the objective by less than the tolerance.
class Settled {
 public:
  explicit Settled(double tolerance) : tolerance_(tolerance) {}
  solvers::Then operator()(int iteration, double fell) {
    if (iteration > 0 && fell < tolerance_ && ++slow_ >= 3) return solvers::Then::settled;
    if (fell >= tolerance_) slow_ = 0;
    return solvers::Then::go_on;
  }

 private:
  double tolerance_;
  int slow_ = 0;
};

}  // namespace

DescentReport descend(const Objective& objective, Unknowns& at, double sigma_px, bool first,
                      ReconstructionMethod method, const DescentOptions& options, int threads) {
  const GaussianBasis basis(sigma_px, threads);
  Unknowns base = at;
  std::vector<double> coefficients(at.z_nm.size(), 0.0);
  if (first) {
    coefficients = basis.deconvolved(basis.sum(at.z_nm), 0.01, 200).data();
    std::fill(base.z_nm.data().begin(), base.z_nm.data().end(), 0.0);
  }
  const Problem problem(objective, base, basis, options.watch);
  solvers::MinimiseOptions how;
  how.search = method == ReconstructionMethod::lbfgs ? solvers::Search::lbfgs
                                                     : solvers::Search::conjugate_gradient;
  how.most_iterations = options.iterations;
  how.most_step_sizes = 30;
  how.function_tolerance = 0;
  how.parameter_tolerance = 0;
  how.gradient_tolerance = 1e-12;
  how.after = Settled(options.tolerance);
  const solvers::Minimised done = solvers::minimise(problem, coefficients, how);
  at = problem.surface_of(coefficients.data());

  DescentReport report;
  report.iterations = done.iterations;
  report.evaluations = problem.evaluations;
  const Objective::State state = objective.evaluate(at);
  const Grid<double> gradient = basis.transpose(objective.gradient(at, state).z_nm);
  for (const double g : gradient.data())
    report.gradient_norm = std::max(report.gradient_norm, std::fabs(g));
  report.ended = done.ended == solvers::Ended::settled      ? "converged"
                 : done.ended == solvers::Ended::iterations ? "iterations"
                                                            : "line search";
  return report;
}

void fit_few(const Objective& o, Unknowns& at, const Watch& watch) {
  for (std::size_t v = 0; v < o.views.size(); ++v)
    o.views[v].fit(at.z_nm, at.views[v], o.fit_mixture, watch);
  const int of_map = o.afm && o.fit_map ? map_numbers : 0;
  const int of_mixture = o.fits_mixture() ? mixture_numbers : 0, n = of_map + of_mixture;
  if (n == 0) return;
  Objective::State state = o.evaluate(at);
  DampedSteps steps;
  for (int iteration = 0; iteration < 20; ++iteration) {
    watch.check();
    // Images of a unit change of each unknown. Those of the SEM need no derivative by heights.
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
    if (of_map) {
      const Grid<double> none(o.frame.width, o.frame.height);
      std::vector<Grid<double>> change, weighed;
      for (int k = 0; k < map_numbers; ++k) {
        MapChange unit{};
        unit[k] = 1;
        change.push_back(o.afm->change(*state.afm, at.z_nm, none, unit));
        weighed.push_back(o.afm->precision(change.back()));
      }
      for (int i = 0; i < map_numbers; ++i)
        for (std::size_t p = 0; p < change[i].size(); ++p) {
          g(i) += change[i].data()[p] * state.afm->pull.data()[p];
          for (int k = 0; k < map_numbers; ++k)
            a(i, k) += change[i].data()[p] * weighed[k].data()[p];
        }
      for (int k = affine_numbers; k < map_numbers; ++k) {
        if (!o.fit_drift) a.row(k).setZero(), a.col(k).setZero(), g(k) = 0;
        a(k, k) += o.fit_drift ? o.drift_precision : 1;
        if (o.fit_drift)
          g(k) += o.drift_precision * (k == affine_numbers ? at.drift_px.x : at.drift_px.y);
      }
    }
    if (of_mixture) {
      const auto images = o.sem->mixture_images(*state.sem, at.mixture);
      for (int i = 0; i < of_mixture; ++i)
        for (std::size_t p = 0; p < state.sem->pull.size() && o.fits(i); ++p)
          g(of_map + i) += state.sem->pull.data()[p] * images[i].data()[p];
      const MixtureChange pull = o.mixture_pull(at.mixture), prior = o.mixture_precision();
      for (int k = 0; k < of_mixture; ++k) g(of_map + k) += pull[static_cast<std::size_t>(k)];
      const auto precision = o.sem->mixture_precision(*state.sem, at.mixture);
      for (int i = 0; i < of_mixture; ++i)
        for (int k = 0; k < of_mixture; ++k)
          a(of_map + i, of_map + k) = !(o.fits(i) && o.fits(k)) ? i == k : precision[i][k];
      for (int k = 0; k < of_mixture; ++k)
        a(of_map + k, of_map + k) += prior[static_cast<std::size_t>(k)];
    }
    const double fell = steps.step(a, g, [&](const Eigen::VectorXd& d) {
      Step step = o.zero();
      for (int k = 0; k < of_map; ++k) step.map[k] = d(k);
      for (int k = 0; k < of_mixture; ++k) step.mixture[k] = d(of_map + k);
      const Unknowns next = o.moved(at, step);
      Objective::State there = o.evaluate(next);
      const double lower = state.value() - there.value();
      if (lower > 0) at = next, state = std::move(there);
      return lower;
    });
    if (fell < settled_step) return;
  }
}

}  // namespace surf::reconstruction
