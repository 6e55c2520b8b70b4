// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "job_libraries.h"
#include "learners.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/tables/cascade_tables.h"
#include "surf/workflow/slope_table.h"

namespace surf::workflow {
namespace {

// The number used by simulations, so that the cache often has them.
constexpr std::int64_t usual_cascades = 10240;

void check(const TrainJob& job) {
  if (job.spot_nm > 0)
    throw UsageError("`beam.spot`", fmt::format("a model '{}' knows of no spot", job.learn.kind),
                     "Leave it out");
  if (!mc::can_replay(mc::make_medium(job.material, job.physics)))
    throw UsageError(
        "`simulation.physics`",
        fmt::format("a model '{}' is made of cascades, which need continuous loss", job.learn.kind),
        "Choose loss=joy-luo");
}

std::shared_ptr<const mc::CascadeLibrary> library_of(const TrainJob& job, JobLibraries& libraries,
                                                     const Watch& watch) {
  const double barrier_ev = mc::make_medium(job.material, job.physics).barrier_ev();
  return libraries.library(
      {job.material, job.physics, job.energy_ev + barrier_ev, job.simulation.seed},
      static_cast<std::size_t>(job.learn.table_electrons.value_or(usual_cascades)),
      job.simulation.threads, {{}, watch.cancel});
}

std::map<std::string, std::string> notes_of(const TrainJob& job,
                                            const mc::CascadeLibrary& library) {
  return {{"physics", mc::format_physics(job.physics)},
          {"seed", std::to_string(job.simulation.seed)},
          {"table.electrons", std::to_string(library.cascades())}};
}

// Far more secondaries stop above the surface than leave it, so the yields of level ground set
// their scale.
Learnt learn_stopping_points(const Lesson& lesson) {
  const TrainJob& job = lesson.job;
  JobLibraries libraries(job.cache, lesson.reporter.counting("cascades"), lesson.reporter.on_note);
  SlopeTableOptions flat;
  flat.specimen = SlopeSpecimen::single_plane;
  flat.last_deg = 0;
  flat.electrons = job.learn.table_electrons.value_or(flat.electrons);
  flat.seed = job.simulation.seed;
  flat.physics = job.physics;
  flat.threads = job.simulation.threads;
  flat.watch = lesson.watch();
  const mc::Estimate yield =
      make_slope_table(job.material, job.energy_ev, flat, &libraries).se.front();
  const auto library = library_of(job, libraries, flat.watch);
  mc::CascadeTableOptions options;
  options.flat_se_yield = yield.mean;
  auto notes = notes_of(job, *library);
  notes["table.flat_se"] = fmt::format("{:.4g} +- {:.2g}", yield.mean, yield.standard_error);
  Learnt learnt{mc::stopping_points(*library, options), 0, {}, std::move(notes)};
  if (!(yield.mean > 0))
    learnt.warnings.push_back(
        "no secondaries left level ground: SE counts all that stop above the surface");
  return learnt;
}

Learnt learn_diffusion_matrix(const Lesson& lesson) {
  JobLibraries libraries(lesson.job.cache, lesson.reporter.counting("cascades"),
                         lesson.reporter.on_note);
  const auto library = library_of(lesson.job, libraries, lesson.watch());
  return {mc::diffusion_matrix(*library), 0, {}, notes_of(lesson.job, *library)};
}

}  // namespace

const Learner stopping_points_learner{
    "stopping-points",
    "electrons that would stop above the surface (Aristov 1991); no images needed",
    {"table_electrons"},
    check,
    learn_stopping_points,
    false};
const Learner diffusion_matrix_learner{
    "diffusion-matrix",     "their flux through facets (Desai, Czyzewski 1990); no images needed",
    {"table_electrons"},    check,
    learn_diffusion_matrix, false};

}  // namespace surf::workflow
