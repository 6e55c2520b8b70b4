// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "learners.h"
#include "surf/core/units.h"
#include "surf/mc/physics/electron_range.h"
#include "surf/sem/fit_facet_network.h"

namespace surf::workflow {
namespace {

FacetNetworkFitOptions options_of(const TrainJob& job) {
  const LearnOptions& o = job.learn;
  FacetNetworkFitOptions options;
  options.scales = o.scales;
  options.range_nm = mc::kanaya_okayama_range_nm(job.material, job.energy_ev);
  options.sided = std::ranges::any_of(job.detectors, mc::looks_from_a_side);
  if (o.hidden) options.hidden = *o.hidden;
  if (o.iterations) options.iterations = *o.iterations;
  if (o.decay) options.decay = *o.decay;
  if (o.model_error) options.tolerance = *o.model_error;
  options.seed = job.simulation.seed;
  options.threads = job.simulation.threads;
  return options;
}

void check(const TrainJob& job) { validate(options_of(job)); }

Learnt learn(const Lesson& lesson) {
  FacetNetworkFitOptions options = options_of(lesson.job);
  options.watch = lesson.watch();
  FacetNetworkFit fit = fit_facet_network(lesson.images, lesson.channels, options);
  return {std::move(fit.parameters),
          0,
          std::move(fit.warnings),
          {{"electron_range", fmt::format("{:.4g} nm", options.range_nm)},
           {"iterations", std::to_string(fit.iterations)},
           {"decay", format_exact(options.decay)},
           {"model_error", format_exact(options.tolerance)},
           {"cost", fmt::format("{:.4g}", fit.cost)}}};
}

}  // namespace

const Learner facet_network_learner{
    "facet-network",
    "a small network on what the filter bank sees and on the sky in view",
    {"scales", "hidden", "iterations", "decay", "model_error"},
    check,
    learn,
    true,
    true};

}  // namespace surf::workflow
