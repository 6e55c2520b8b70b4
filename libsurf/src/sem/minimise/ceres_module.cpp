// SPDX-License-Identifier: GPL-3.0-or-later
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>

#include "minimise.h"

namespace surf::solvers {
namespace {

class Problem final : public ceres::FirstOrderFunction {
 public:
  explicit Problem(const SmoothFunction& function) : function_(function) {}
  bool Evaluate(const double* at, double* value, double* gradient) const override {
    return function_.evaluate(at, value, gradient);
  }
  int NumParameters() const override { return function_.size(); }

 private:
  const SmoothFunction& function_;
};

class Teller final : public ceres::IterationCallback {
 public:
  explicit Teller(const MinimiseOptions& options) : options_(options) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    switch (options_.after(s.iteration, s.cost_change)) {
      case Then::go_on:
        return ceres::SOLVER_CONTINUE;
      case Then::settled:
        return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
      case Then::stop:
        break;
    }
    return ceres::SOLVER_ABORT;
  }

 private:
  const MinimiseOptions& options_;
};

Ended ended(ceres::TerminationType type) {
  switch (type) {
    case ceres::CONVERGENCE:
    case ceres::USER_SUCCESS:
      return Ended::settled;
    case ceres::NO_CONVERGENCE:
      return Ended::iterations;
    case ceres::USER_FAILURE:
      return Ended::stopped;
    default:
      return Ended::line_search;
  }
}

Minimised ceres_minimise(const SmoothFunction& function, std::span<double> at,
                         const MinimiseOptions& options) {
  const ceres::GradientProblem problem(new Problem(function));  // it takes ownership
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = options.search == Search::bfgs ? ceres::BFGS
                                      : options.search == Search::lbfgs
                                          ? ceres::LBFGS
                                          : ceres::NONLINEAR_CONJUGATE_GRADIENT;
  solver.nonlinear_conjugate_gradient_type = ceres::POLAK_RIBIERE;
  solver.line_search_type = ceres::WOLFE;
  solver.max_lbfgs_rank = options.lbfgs_rank;
  solver.max_num_iterations = options.most_iterations;
  solver.max_num_line_search_step_size_iterations = options.most_step_sizes;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  solver.logging_type = ceres::SILENT;
  solver.update_state_every_iteration = false;
  Teller teller(options);
  if (options.after) solver.callbacks.push_back(&teller);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(solver, problem, at.data(), &summary);
  return {ended(summary.termination_type),
          std::max(0, static_cast<int>(summary.iterations.size()) - 1), summary.final_cost};
}

constexpr CeresLibrary table{ceres_minimise};

}  // namespace
}  // namespace surf::solvers

SEMSURF_MODULE(ceres, surf::solvers::table)
