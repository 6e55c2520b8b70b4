// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "../common_parameters.h"
#include "surf/workflow/chain_chart_job.h"
#include "surf/workflow/chart_job.h"

namespace surf::workflow {
namespace {

/// The parameters common to charts of scenes and of samples.
template <class Job>
void describe_common(ParameterVisitor& visit, Job& job) {
  describe_folder(visit, job.folder, "Folder for the chart and what it is made from");
  visit(job.quick, {.name = "chart.quick",
                    .help = "Make a quick chart: few settings of each method, small trainings, a "
                            "finest accuracy of 3% and fewer primaries"});
  describe_names(visit, job.families,
                 {.name = "chart.methods",
                  .help = "Methods to chart, of those below, with commas between "
                          "them",
                  .otherwise = "all",
                  .form = "NAME,..."});
  visit(
      job.seed,
      {.name = "chart.seed",
       .help = "Seed of the random numbers: the same seed gives the same numbers, but for times"});
  describe_threads(visit, job.threads);
}

}  // namespace

void describe(ParameterVisitor& visit, ChartJob& job) {
  describe_common(visit, job);
  visit(job.finest, {.name = "chart.accuracy",
                     .help = "Finest accuracy that methods are asked for",
                     .unit = Unit::share,
                     .limits = within(0.001, 0.1)});
  std::optional<double> reference =
      job.reference_accuracy != 0 ? std::optional(job.reference_accuracy) : std::nullopt;
  visit(reference, {.name = "chart.reference",
                    .help = "Accuracy of the reference",
                    .unit = Unit::share,
                    .limits = within(1e-4, 0.05),
                    .otherwise = "a third of the finest",
                    .level = Level::advanced});
  job.reference_accuracy = reference.value_or(0);
  visit(job.compared_pixels, {.name = "chart.compared",
                              .help = "Number of the reference's pixels, roughly",
                              .limits = within(16, 1 << 24),
                              .level = Level::advanced});
  visit(
      job.most_primaries,
      {.name = "chart.most",
       .help =
           "Primaries in the whole image above which settings are left out, direct ones with more "
           "than a twentieth of it",
       .limits = within(1e5, 1e15),
       .form = "N",
       .level = Level::advanced});
  visit(job.surfaces, {.name = "chart.surfaces",
                       .help = "Surfaces that fast models learn on",
                       .limits = within(2, 10'000),
                       .level = Level::advanced});
  visit(job.surface_px, {.name = "chart.surface_size",
                         .help = "Pixels across each of those surfaces",
                         .limits = within(16, 4096),
                         .level = Level::advanced});
}

void describe(ParameterVisitor& visit, ChainChartJob& job) {
  describe_common(visit, job);
  std::optional<int> draws = job.draws != 0 ? std::optional(job.draws) : std::nullopt;
  visit(draws, {.name = "chart.draws",
                .help = "Registrations of each way and offset",
                .limits = within(1, 1000),
                .otherwise = "10, quickly 3"});
  job.draws = draws.value_or(0);
  describe_path(visit, job.model,
                {.name = "chart.model",
                 .help = "The fast model of SEM images",
                 .otherwise = "one that was kept is taken, else one is trained and kept",
                 .form = "FILE.json",
                 .file = FileRole::read});
}

}  // namespace surf::workflow
