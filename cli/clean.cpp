// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "options.h"
#include "surf/afm/clean.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(What is asked for happens in this order: spikes, median, closing. Widths are odd numbers of samples.
At the border of the image and near holes the neighbourhood is what there is of it.

Examples:
  semsurf clean scan.gsf --spikes 3:0.5nm -o clean.gsf
      only heights that are more than 0.5 nm off the median of the 3 x 3 around them become it
  semsurf clean scan.gwy --median 5 --disc -o smooth.gsf
  semsurf clean scan.gsf --closing 5 --fill-holes -o filled.tif)";

struct Options {
  ScanInput scan;
  std::optional<std::string> output, median, spikes, closing, threads;
  bool disc = false, fill_holes = false, quiet = false;
};

struct Plan {
  std::optional<MedianOptions> spikes, median;
  std::optional<ClosingOptions> closing;
};

int parse_width(const std::string& text, const char* subject) {
  const auto width = parse_whole(text, subject, 1, 2001);
  if (width % 2 == 0)
    throw UsageError(subject, fmt::format("{} is even: such a neighbourhood has no middle", text),
                     fmt::format("Give {} or {}", width - 1, width + 1));
  return static_cast<int>(width);
}

MedianOptions parse_median(const std::string& width, const char* subject, const Options& o, int threads) {
  return {.radius = parse_width(width, subject) / 2,
          .neighbourhood = o.disc ? Neighbourhood::disc : Neighbourhood::square,
          .fill_holes = o.fill_holes,
          .threads = threads};
}

Plan make_plan(const Options& o) {
  if (o.scan.file.empty()) throw UsageError("clean", "no scan is given", "Name a file to read");
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o clean.gsf");
  if (!o.median && !o.spikes && !o.closing)
    throw UsageError("clean", "nothing is to be done", "Add --spikes 3:0.5nm, --median 3 or --closing 5");
  if (o.disc && !o.median && !o.spikes)
    throw UsageError("--disc", "a closing is by a square", "Leave out --disc, or add --median or --spikes");
  io::check_height_field_target(*o.output);
  const int threads = parse_threads(o.threads);
  Plan p;
  if (o.spikes) {
    const std::size_t colon = o.spikes->find(':');
    if (colon == std::string::npos)
      throw UsageError("--spikes", fmt::format("'{}' names no limit", *o.spikes), "Write a width and a limit, as 3:0.5nm");
    p.spikes = parse_median(o.spikes->substr(0, colon), "--spikes", o, threads);
    p.spikes->limit_nm = parse_length_nm(o.spikes->substr(colon + 1), "--spikes");
    if (!(p.spikes->limit_nm > 0))
      throw UsageError("--spikes", "the limit is not above 0", "Write a width and a limit, as 3:0.5nm");
  }
  if (o.median) p.median = parse_median(*o.median, "--median", o, threads);
  if (o.closing) p.closing = {parse_width(*o.closing, "--closing"), o.fill_holes, threads};
  return p;
}

void print_summary(const char* what, const CleanSummary& s, const HeightField& field) {
  print("{:<10} {} of {} heights changed{}{}\n", what, s.changed, field.z_nm.size(),
             s.filled ? fmt::format(", {} holes filled", s.filled) : "",
             s.holes ? fmt::format(", {} holes left", s.holes) : "");
}

std::map<std::string, std::string> recorded(const Options& o) {
  std::map<std::string, std::string> r;
  const auto add = [&](const char* name, const std::optional<std::string>& value) {
    if (value) r[name] = *value;
  };
  add("channel", o.scan.channel), add("z-unit", o.scan.z_unit), add("pixel-size", o.scan.pixel_size);
  add("spikes", o.spikes), add("median", o.median), add("closing", o.closing);
  if (o.disc) r["disc"] = "on";
  if (o.fill_holes) r["fill-holes"] = "on";
  return r;
}

int work(const Options& o) {
  Plan plan = make_plan(o);
  HeightField field = read_scan(o.scan, o.quiet).field;
  CleanSummary summary;
  Watched watched(!o.quiet);
  const auto report = [&](const char* what) {
    watched.clear();
    if (!o.quiet) print_summary(what, summary, field);
  };
  if (plan.spikes) {
    plan.spikes->watch = watched.watch();
    field = median_filter(field, *plan.spikes, summary);
    report("spikes");
  }
  if (plan.median) {
    plan.median->watch = watched.watch();
    field = median_filter(field, *plan.median, summary);
    report("median");
  }
  if (plan.closing) {
    plan.closing->watch = watched.watch();
    field = flat_closing(field, *plan.closing, summary);
    report("closing");
  }
  io::write_height_field(*o.output, field, provenance_of("clean", recorded(o), {o.scan.file}));
  if (!o.quiet) print("{:<10} {}\n", "written", *o.output);
  return 0;
}

}  // namespace

void add_clean(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("clean", "Take spikes, noise and pits out of an AFM scan");
  sub->group("Commands");
  add_scan_input(*sub, o->scan);
  const char* cleaning = "Cleaning";
  sub->add_option("--spikes", o->spikes, "The median where a height is off it by more than the limit")
      ->type_name("WIDTH:LENGTH")->group(cleaning);
  sub->add_option("--median", o->median, "The median of this many samples squared")
      ->type_name("WIDTH")->group(cleaning);
  sub->add_option("--closing", o->closing, "Fill pits narrower than this many samples")
      ->type_name("WIDTH")->group(cleaning);
  sub->add_flag("--disc", o->disc, "Medians of discs instead of squares")->group(cleaning);
  sub->add_flag("--fill-holes", o->fill_holes, "Give holes the height found for them too")->group(cleaning);
  const char* output = "Output";
  add_surface_output(*sub, o->output);
  add_threads_option(*sub, o->threads)->group(output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
