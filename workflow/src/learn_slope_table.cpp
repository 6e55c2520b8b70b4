// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "job_libraries.h"
#include "learners.h"
#include "surf/core/units.h"
#include "surf/workflow/slope_table.h"

namespace surf::workflow {
namespace {

double largest_relative_error(const SlopeTable& table) {
  double largest = 0;
  for (const auto* yields : {&table.se, &table.bse})
    for (const mc::Estimate& y : *yields)
      if (y.mean > 0) largest = std::max(largest, y.standard_error / y.mean);
  return largest;
}

template <SlopeSpecimen specimen>
Learnt learn(const Lesson& lesson) {
  const TrainJob& job = lesson.job;
  SlopeTableOptions options;
  options.specimen = specimen;
  options.electrons = job.learn.table_electrons.value_or(options.electrons);
  options.seed = job.simulation.seed;
  options.physics = job.physics;
  options.threads = job.simulation.threads;
  options.watch = lesson.watch();
  JobLibraries libraries(job.cache, lesson.reporter.counting("cascades"), lesson.reporter.on_note);
  const SlopeTable table = make_slope_table(job.material, job.energy_ev, options, &libraries);
  return {to_slope_model(table),
          0,
          {},
          {{"physics", mc::format_physics(job.physics)},
           {"seed", std::to_string(options.seed)},
           {"table.electrons", fmt::format("{} at each angle", options.electrons)},
           {"table.stderr", format_share(largest_relative_error(table)) + " of a yield at most"}}};
}

}  // namespace

const Learner slope_table_learner{
    "slope-table",
    "yields of tilted planes (thesis, appendix E.1); simulated, no images needed",
    {"table_electrons"},
    nullptr,
    learn<SlopeSpecimen::single_plane>,
    false};
const Learner slope_table_two_planes_learner{"slope-table-two-planes",
                                             "the same beside level ground; no images needed",
                                             {"table_electrons"},
                                             nullptr,
                                             learn<SlopeSpecimen::two_planes>,
                                             false};

}  // namespace surf::workflow
