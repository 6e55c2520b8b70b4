// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <utility>

#include "commands.h"
#include "dry_run_summary.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "joined_team.h"
#include "simulate_options.h"
#include "simulate_summary.h"
#include "surf/workflow/dry_run.h"
#include "surf/workflow/simulate_job.h"
#include "surf/workflow/specimen_reader.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr double pilot_seconds = 10;

// Who leads says it; it is alone in this.
int try_out(const SimulateOptions& options, const std::string& command_line) {
  if (!workflow::leads(team())) return 0;
  workflow::SimulateJob job = make_simulate_job(options.parameters.given(), options.quiet,
                                                command_line, workflow::specimen_reader());
  workflow::DryRun run;
  {
    const JobReporter reporter(options.quiet);
    run = workflow::dry_run(std::move(job), team() ? team()->size() : 1, pilot_seconds, reporter);
  }
  for (const std::string& warning : run.warnings) print_warning(warning);
  print_dry_run(run);
  return 0;
}

int simulate(const SimulateOptions& options, const std::string& command_line) {
  if (options.dry_run) return try_out(options, command_line);
  workflow::SimulateJob job;
  workflow::together(team(), [&] {
    job = make_simulate_job(options.parameters.given(), options.quiet, command_line,
                            workflow::specimen_reader(workflow::node_of(team())));
  });
  const int threads = job.execution.threads;
  workflow::SimulateSummary summary;
  {
    const JobReporter reporter(options.quiet);
    summary = workflow::run(std::move(job), reporter, team());
  }
  if (!workflow::leads(team())) return 0;
  if (!options.quiet) cli::print_summary(threads, summary);
  if (!summary.result.complete) return exit_interrupted;
  return summary.statistics.missed > 0 ? exit_untrustworthy : 0;
}

}  // namespace

void add_simulate(CLI::App& app, Action& action, const std::string& command_line) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* sub =
      app.add_subcommand("simulate", "Secondary- and backscattered-electron images of a specimen");
  add_simulate_options(*sub, *options);
  sub->callback([options, &action, command_line] {
    action = [options, command_line] { return simulate(*options, command_line); };
  });
}

}  // namespace surf::cli
