// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "commands.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "joined_team.h"
#include "model_tables.h"
#include "surf/workflow/train_job.h"
#include "terminal.h"
#include "train_options.h"

namespace surf::cli {
namespace {

void print_training(const workflow::TrainSummary& s) {
  const TrainedModel& model = s.model;
  print_line("model", format_model(model));
  print_line("for", format_scope(model.scope));
  if (!s.images.empty())
    print_line("images", fmt::format("{} simulated, {} there before, in {}", s.images_made,
                                     s.images_found, s.images.string()));
  if (learnt_from(model.record) > 0) print_line("range", format_range(model.record.range));
  if (model.record.condition_number != 0)
    print_line("condition", fmt::format("{:.3g}", model.record.condition_number));
  std::string label = "off by";
  for (const std::string& line : residual_table(model.record)) {
    print_line(label, line);
    label.clear();
  }
  if (label.empty())
    print_line("", "in % of the mean signal; rms without the images' noise, mean with it");
  print_written(s.written);
}

int train(const TrainOptions& options) {
  workflow::TrainJob job;
  workflow::together(team(), [&] { job = make_train_job(options); });
  workflow::TrainSummary summary;
  {
    const JobReporter reporter(options.quiet);
    summary = workflow::run(job, reporter, team());
  }
  if (!workflow::leads(team())) return 0;
  if (!summary.complete) {
    print_note(summary.images.empty()
                   ? "stopped: there is no model yet"
                   : fmt::format("stopped: there is no model yet. What is simulated is kept in {}; "
                                 "the same command goes "
                                 "on from there",
                                 summary.images.string()));
    return exit_interrupted;
  }
  if (!options.quiet) print_training(summary);
  return 0;
}

}  // namespace

void add_train(CLI::App& app, Action& action) {
  const auto options = std::make_shared<TrainOptions>();
  CLI::App* sub =
      app.add_subcommand("train", "A fast model of SEM images, learnt from simulated or real ones");
  add_train_options(*sub, *options);
  sub->callback([options, &action] { action = [options] { return train(*options); }; });
}

}  // namespace surf::cli
