// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/morphology.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "options.h"
#include "surf/afm/height_range.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "terminal.h"
#include "tip_options.h"

namespace surf::cli {
namespace {

/// A command that takes a field and a tip and gives a field.
struct Command {
  const char *name, *title, *done, *examples;
  HeightField (*run)(const HeightField&, const Tip&, double distance_nm, const MorphologyOptions&);
};

HeightField run_erode(const HeightField& f, const Tip& t, double d, const MorphologyOptions& o) {
  return d > 0 ? erode_noncontact(f, t, d, o) : erode(f, t, o);
}
HeightField run_dilate(const HeightField& f, const Tip& t, double d, const MorphologyOptions& o) {
  return d > 0 ? dilate_noncontact(f, t, d, o) : dilate(f, t, o);
}

constexpr Command erode_command{
    "erode", "Take a tip out of a scan: the highest surface that agrees with it", "eroded",
    R"(The result is an upper bound of the surface; 'semsurf certainty' says where it is the surface.
Noise lowers it: level and clean the scan first.

Examples:
  semsurf erode scan.gsf --tip tip.gsf -o surface.gsf
  semsurf erode scan.spm --channel Height --tip tip.gsf --distance 2nm --upsample 3 -o surface.vti)",
    run_erode};

constexpr Command dilate_command{
    "dilate", "The scan that a tip makes of a surface", "dilated",
    R"(Examples:
  semsurf dilate surface.gsf --tip tip.gsf -o scan.gsf
  semsurf dilate surface.tif --pixel-size 2nm --tip tip.gsf --distance 3nm -o scan.gsf)",
    run_dilate};

struct Options {
  ScanInput input;
  std::optional<std::string> tip, upsample, distance, output, threads;
  bool quiet = false;
};

double parse_distance(const std::optional<std::string>& text) {
  const double nm = text ? parse_length_nm(*text, "--distance") : 0;
  if (nm >= 0) return nm;
  throw UsageError("--distance", fmt::format("'{}' is below 0", *text), "Give a length, as 3nm");
}

std::string relief(const HeightField& f) {
  const HeightRange range = height_range(std::span(&f, 1));
  return fmt::format("{} to {}", format_length(range.low_nm), format_length(range.high_nm));
}

int work(const Command& command, const Options& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o surface.gsf");
  io::check_height_field_target(*o.output);
  MorphologyOptions options;
  if (o.upsample) options.upsample = static_cast<int>(parse_whole(*o.upsample, "--upsample", 1, 32));
  options.threads = parse_threads(o.threads);
  const double distance = parse_distance(o.distance);
  if (!o.tip) throw UsageError("--tip", "no tip is given", "Add --tip tip.gsf");
  const io::HeightFieldFile scan = read_scan(o.input, o.quiet);
  const Tip tip = read_tip_for(o.tip, scan.field, o.quiet);
  Watched watched(!o.quiet);
  options.watch = watched.watch();
  const HeightField result = command.run(scan.field, tip, distance, options);
  watched.clear();
  std::map<std::string, std::string> made{{"upsample", fmt::format("{}", options.upsample)},
                                          {"distance_nm", fmt::format("{}", distance)}};
  if (!scan.channel.empty()) made["channel"] = scan.channel;
  io::write_height_field(*o.output, result, provenance_of(command.name, made, {o.input.file, *o.tip}));
  if (o.quiet) return 0;
  print("{:<10} {} x {} pixels of {}, heights {}\n", "scan", scan.field.z_nm.width(),
             scan.field.z_nm.height(), format_length(scan.field.pitch_x_nm), relief(scan.field));
  print("{:<10} {} x {} pixels\n", "tip", tip.z_nm.width(), tip.z_nm.height());
  print("{:<10} heights {}\n", command.done, relief(result));
  print("{:<10} {}\n", "written", *o.output);
  return 0;
}

void add(CLI::App& app, Action& action, const Command& command) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand(command.name, command.title);
  sub->group("Commands");
  add_scan_input(*sub, o->input);
  add_tip_input(*sub, o->tip);
  sub->add_option("--upsample", o->upsample, "Of non-contact scans: interpolate to so many samples per pixel (1)")
      ->type_name("N");
  sub->add_option("--distance", o->distance, "That the tip keeps from the surface, of non-contact scans (0nm)")
      ->type_name("LENGTH");
  add_surface_output(*sub, o->output);
  add_threads_option(*sub, o->threads);
  add_quiet_flag(*sub, o->quiet);
  sub->footer(command.examples);
  sub->callback([o, &action, &command] { action = [o, &command] { return work(command, *o); }; });
}

}  // namespace

void add_erode(CLI::App& app, Action& action) { add(app, action, erode_command); }
void add_dilate(CLI::App& app, Action& action) { add(app, action, dilate_command); }

}  // namespace surf::cli
