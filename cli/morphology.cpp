// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/morphology_job.h"

#include <fmt/format.h>

#include <memory>
#include <span>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "scan_batch.h"
#include "surf/afm/height_range.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "terminal.h"
#include "tip_options.h"

namespace surf::cli {
namespace {

using workflow::MorphologyOperation;

/// A command that takes a field and a tip and gives a field.
struct Command {
  MorphologyOperation operation;
  const char *title, *done, *examples;
};

constexpr Command erode_command{
    MorphologyOperation::erode, "Take a tip out of a scan: the highest surface that agrees with it",
    "eroded",
    R"(The result is an upper bound of the surface; 'semsurf certainty' says where it is the surface.
Noise lowers it: level and clean the scan first.

Examples:
  semsurf erode scan.gsf --tip tip.gsf -o surface.gsf
  semsurf erode scan.spm --height-channel Height --tip tip.gsf --distance 2nm --upsample 3 -o surface.vti)"};

constexpr Command dilate_command{MorphologyOperation::dilate,
                                 "The scan that a tip makes of a surface", "dilated",
                                 R"(Examples:
  semsurf dilate surface.gsf --tip tip.gsf -o scan.gsf
  semsurf dilate surface.tif --height-pitch 2nm --tip tip.gsf --distance 3nm -o scan.gsf)"};

constexpr Command open_command{
    MorphologyOperation::open,
    "Take off a scan what a tip cannot have touched: erosion, then dilation", "opened",
    R"(The result is nowhere above the scan, and equal to it where the tip can touch it from below. What is
taken off, this tip cannot have made: noise, or a sharper tip.

Examples:
  semsurf open scan.gsf --tip tip.gsf -o opened.gsf)"};

constexpr Command close_command{
    MorphologyOperation::close,
    "Fill what a tip does not reach of a surface: dilation, then erosion", "closed",
    R"(The result is nowhere below the surface, and equal to it where the tip can touch it: the most that scans
by this tip can tell.

Examples:
  semsurf close surface.gsf --tip tip.gsf -o closed.gsf)"};

struct MorphologyArguments {
  BoundParameters bound;
  std::vector<std::string> scans;
  std::optional<std::string> tip, output;
  bool quiet = false;
};

std::string relief(const HeightField& f) {
  const HeightRange range = height_range(std::span(&f, 1));
  return fmt::format("{} to {}", format_length(range.low_nm), format_length(range.high_nm));
}

void apply(const Command& command, const MorphologyArguments& o,
           const workflow::MorphologyParameters& parameters, const io::HeightReadOptions& reading,
           const BatchStep& file) {
  const HeightField scan = read_scan(file.scan, reading, o.quiet).field;
  const Tip tip = read_tip_for(o.tip, scan, o.quiet);
  const HeightField result =
      workflow::morphology(command.operation, scan, tip, parameters, JobReporter(o.quiet));
  io::write_height_field(
      *file.output, result,
      workflow::step_record(name(command.operation), workflow::records_of(parameters, reading),
                            {file.scan, *o.tip}));
  if (o.quiet) return;
  if (file.one_of_many) print("{}\n", file.scan);
  print("{:<10} {} x {} pixels of {}, heights {}\n", "scan", scan.z_nm.width(), scan.z_nm.height(),
        format_length(scan.pitch_x_nm), relief(scan));
  print("{:<10} {} x {} pixels\n", "tip", tip.z_nm.width(), tip.z_nm.height());
  print("{:<10} heights {}\n", command.done, relief(result));
  print("{:<10} {}\n", "written", *file.output);
}

int morphology_work(const Command& command, const MorphologyArguments& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o surface.gsf");
  workflow::MorphologyParameters parameters;
  io::HeightReadOptions reading;
  o.bound.apply(parameters), o.bound.apply(reading);
  parameters.threads = threads_of(o.bound);
  if (!o.tip) throw UsageError("--tip", "no tip is given", "Add --tip tip.gsf");
  return for_each_scan(
      batch_of(o.scans, o.output, name(command.operation)),
      [&](const BatchStep& file) { apply(command, o, parameters, reading, file); });
}

void add(CLI::App& app, Action& action, const Command& command) {
  const auto o = std::make_shared<MorphologyArguments>();
  CLI::App* sub = app.add_subcommand(name(command.operation), command.title);
  add_scan_inputs(*sub, o->bound, o->scans);
  add_tip_input(*sub, o->tip);
  o->bound.looks["morphology.distance"].hidden = command.operation == MorphologyOperation::open ||
                                                 command.operation == MorphologyOperation::close;
  o->bound.add<workflow::MorphologyParameters>(*sub, "Options");
  add_surface_output(*sub, o->output);
  add_threads_option(*sub, o->bound, "Options");
  add_quiet_flag(*sub, o->quiet);
  sub->footer(command.examples);
  sub->callback(
      [o, &action, &command] { action = [o, &command] { return morphology_work(command, *o); }; });
}

}  // namespace

void add_erode(CLI::App& app, Action& action) { add(app, action, erode_command); }
void add_dilate(CLI::App& app, Action& action) { add(app, action, dilate_command); }
void add_open(CLI::App& app, Action& action) { add(app, action, open_command); }
void add_close(CLI::App& app, Action& action) { add(app, action, close_command); }

}  // namespace surf::cli
