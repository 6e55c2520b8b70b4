// SPDX-License-Identifier: GPL-3.0-or-later
#include "global_optimisers.h"

#include <nlopt.h>

#include <memory>
#include <stdexcept>

#include "processor_time.h"

namespace surf::bench {
namespace {

using Handle = std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)>;

nlopt_algorithm algorithm(GlobalOptimiser optimiser) {
  switch (optimiser) {
    case GlobalOptimiser::crs2:
      return NLOPT_GN_CRS2_LM;
    case GlobalOptimiser::isres:
      return NLOPT_GN_ISRES;
    case GlobalOptimiser::direct_l:
      return NLOPT_GN_DIRECT_L;
    case GlobalOptimiser::esch:
      return NLOPT_GN_ESCH;
    default:
      return NLOPT_G_MLSL_LDS;
  }
}

struct Watched {
  const BoxProblem& problem;
  double begin, limit_s;
  nlopt_opt optimiser, local;
  GlobalRun run;
  BestSoFar best;

  double seconds() const { return processor_seconds() - begin; }

  double value(const double* at, double* gradient) {
    const double v = problem.value(at, gradient);
    ++run.evaluations;
    if (seconds() > limit_s) {
      nlopt_force_stop(local);
      nlopt_force_stop(optimiser);
    }
    if (run.evaluations > 1 && v >= best.value) return v;
    best = {seconds(), v, {at, at + problem.start.size()}};
    constexpr double later = 1.05;
    if (run.history.empty() || best.seconds > later * run.history.back().seconds)
      run.history.push_back(best);
    return v;
  }
};

double call(unsigned, const double* at, double* gradient, void* data) {
  return static_cast<Watched*>(data)->value(at, gradient);
}

}  // namespace

std::string name(GlobalOptimiser optimiser) {
  switch (optimiser) {
    case GlobalOptimiser::crs2:
      return "CRS2";
    case GlobalOptimiser::isres:
      return "ISRES";
    case GlobalOptimiser::direct_l:
      return "DIRECT-L";
    case GlobalOptimiser::esch:
      return "ESCH";
    default:
      return "MLSL, L-BFGS";
  }
}

GlobalRun minimise(GlobalOptimiser optimiser, const BoxProblem& problem, double seconds,
                   std::uint64_t seed) {
  const auto numbers = static_cast<unsigned>(problem.start.size());
  nlopt_srand(static_cast<unsigned long>(seed));
  const Handle handle(nlopt_create(algorithm(optimiser), numbers), nlopt_destroy);
  if (!handle) throw std::runtime_error("NLopt makes no optimiser of so many numbers");
  const Handle local(nlopt_create(NLOPT_LD_LBFGS, numbers), nlopt_destroy);
  Watched watched{problem, processor_seconds(), seconds, handle.get(), local.get(), {}, {}};
  nlopt_set_min_objective(handle.get(), call, &watched);
  nlopt_set_lower_bounds(handle.get(), problem.low.data());
  nlopt_set_upper_bounds(handle.get(), problem.high.data());
  if (optimiser == GlobalOptimiser::mlsl) {
    nlopt_set_ftol_abs(local.get(), 1e-3);
    nlopt_set_local_optimizer(handle.get(), local.get());
  }
  std::vector<double> at = problem.start;
  double least = 0;
  nlopt_optimize(handle.get(), at.data(), &least);
  if (!watched.best.at.empty() && watched.best.seconds > watched.run.history.back().seconds)
    watched.run.history.push_back(watched.best);
  return std::move(watched.run);
}

}  // namespace surf::bench
