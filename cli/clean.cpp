// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "scan_batch.h"
#include "surf/core/error.h"
#include "surf/workflow/clean_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::CleanParameters;

constexpr const char* clean_examples =
    R"(What is asked for happens in this order: spikes, median, closing. Widths are odd numbers of samples.
At the border of the image and near holes the neighbourhood is what there is of it.

Examples:
  semsurf clean scan.gsf --spikes 3:0.5nm -o clean.gsf
      only heights that are more than 0.5 nm off the median of the 3 x 3 around them become it
  semsurf clean scans/ --median 3 -o clean/             each to clean/NAME.gsf
  semsurf clean scan.gwy --median 5 --disc -o smooth.gsf
  semsurf clean scan.gsf --closing 5 --fill-holes -o filled.tif)";

struct CleanArguments {
  BoundParameters bound;
  std::vector<std::string> scans;
  std::optional<std::string> output;
  bool quiet = false;
};

CleanParameters parameters_of(const CleanArguments& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o clean.gsf");
  CleanParameters p;
  o.bound.apply(p);
  if (!p.median && !p.spikes && !p.closing)
    throw UsageError("clean", "nothing is to be done",
                     "Add --spikes 3:0.5nm, --median 3 or --closing 5");
  if (p.disc && !p.median && !p.spikes)
    throw UsageError("--disc", "a closing is by a square",
                     "Leave out --disc, or add --median or --spikes");
  p.threads = threads_of(o.bound);
  return p;
}

void print_summary(const char* what, const CleanSummary& s, const HeightField& field) {
  print("{:<10} {} of {} heights changed{}{}\n", what, s.changed, field.z_nm.size(),
        s.filled ? fmt::format(", {} holes filled", s.filled) : "",
        s.holes ? fmt::format(", {} holes left", s.holes) : "");
}

void clean(const CleanArguments& o, const CleanParameters& parameters,
           const io::HeightReadOptions& reading, const BatchStep& file) {
  const HeightField scan = read_scan(file.scan, reading, o.quiet).field;
  const workflow::CleanResult cleaned = workflow::clean(scan, parameters, JobReporter(o.quiet));
  if (!o.quiet) {
    if (file.one_of_many) print("{}\n", file.scan);
    if (cleaned.spikes) print_summary("spikes", *cleaned.spikes, scan);
    if (cleaned.median) print_summary("median", *cleaned.median, scan);
    if (cleaned.closing) print_summary("closing", *cleaned.closing, scan);
  }
  io::write_height_field(
      *file.output, cleaned.field,
      workflow::step_record("clean", workflow::records_of(cleaned.used, reading), {file.scan}));
  if (!o.quiet) print("{:<10} {}\n", "written", *file.output);
}

int clean_work(const CleanArguments& o) {
  const CleanParameters parameters = parameters_of(o);
  io::HeightReadOptions reading;
  o.bound.apply(reading);
  return for_each_scan(batch_of(o.scans, o.output, "clean"),
                       [&](const BatchStep& file) { clean(o, parameters, reading, file); });
}

}  // namespace

void add_clean(CLI::App& app, Action& action) {
  const auto o = std::make_shared<CleanArguments>();
  CLI::App* sub = app.add_subcommand("clean", "Take spikes, noise and pits out of an AFM scan");
  add_scan_inputs(*sub, o->bound, o->scans);
  o->bound.add<CleanParameters>(*sub, "Cleaning");
  const char* output = "Output";
  add_surface_output(*sub, o->output);
  add_threads_option(*sub, o->bound, output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(clean_examples);
  sub->callback([o, &action] { action = [o] { return clean_work(*o); }; });
}

}  // namespace surf::cli
