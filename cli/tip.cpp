// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "surf/afm/height_range.h"
#include "surf/afm/tip_measure.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/plot.h"
#include "surf/io/tip_file.h"
#include "surf/workflow/tip_job.h"
#include "terminal.h"
#include "tip_plot.h"

namespace surf::cli {
namespace {

constexpr const char* tip_examples =
    R"(Without --threshold, thresholds are swept, and the tip is chosen that leaves of the scan what its
noise explains; the chart shows the whole curve, so that you can disagree:
  semsurf tip scan.gsf -o tip.gsf --plot tip.svg
Level the scan first ('semsurf level'). Two other answers, named as such:
  semsurf tip scan.gsf --answer outer -o bound.gsf
      an outer bound: in 95 % of noise draws nowhere sharper than the tip, but blunt
  semsurf tip a.gsf --also b.gsf --also c.gsf --answer best -o tip.gsf
      the most likely tip, from several scans by it, with standard errors; best for noisy frames
A tip by its shape, from the scan of a known surface, or at a threshold of your own:
  semsurf tip --shape cone:10nm,15deg --tip-size 41 --height-pitch 2nm -o tip.gsf
  semsurf tip grating_scan.gsf --characterizer grating.gsf -o tip.gsf
  semsurf tip scan.gsf --threshold 0.5nm --apex-tolerance 0.5nm -o tip.gsf)";

struct TipArguments {
  BoundParameters bound;
  std::string scan;
  std::vector<std::string> also;
  std::optional<std::string> characterizer, plot, output;
  bool quiet = false;

  template <class Struct>
  Struct told() const {
    Struct parameters;
    bound.apply(parameters);
    return parameters;
  }
};

std::vector<HeightField> read_scans(const TipArguments& o) {
  const auto reading = o.told<io::HeightReadOptions>();
  std::vector<HeightField> scans{read_scan(o.scan, reading, o.quiet).field};
  for (const std::string& file : o.also) scans.push_back(read_scan(file, reading, o.quiet).field);
  return scans;
}

// Of the samples that the tip has; above 0 for all but a flat one.
double depth_of(const Tip& tip) {
  double lowest = 0;
  for (const double z : tip.z_nm.data())
    if (std::isfinite(z)) lowest = std::min(lowest, z);
  return -lowest;
}

void print_tip(const Tip& tip, double depth_nm) {
  print("{:<10} {} x {} samples of {}, down to {}\n", "tip", tip.z_nm.width(), tip.z_nm.height(),
        format_length(tip.pitch_x_nm), format_length(-depth_of(tip)));
  try {
    TipMeasures m = measure_tip(tip);
    // Thresholds leave ends flat: what lies deeper may tell a radius.
    if (const double whole_nm = depth_of(tip); !std::isfinite(m.radius_nm) && whole_nm > 0)
      m = measure_tip(tip, {.fit_depth_nm = whole_nm});
    if (std::isfinite(m.radius_nm))
      print("{:<10} {} (fitted down to {}, residual {})", "radius", format_length(m.radius_nm),
            format_length(m.fit_depth_nm), format_length(m.radius_residual_nm));
    else print("{:<10} infinite: the tip is flat", "radius");
    if (m.half_angle_rad)
      print(", half angle {:.1f} degrees", *m.half_angle_rad / degrees_to_radians);
    print("\n");
  } catch (const InvalidInput& e) {  // a flat end, or too few samples
    print("{:<10} not known: {}\n", "radius", e.reason());
  }
  print("{:<10} {:.4g} nm^3 down to {}\n", "volume", tip_volume_nm3(tip, depth_nm),
        format_length(depth_nm));
}

void print_sweep(const TipSweep& sweep) {
  const SweptTip& c = sweep.curve[sweep.chosen];
  print("{:<10} {} of {} to {}; residual {}, expected {}; largest jump of volume below {}\n",
        "threshold", format_length(c.threshold_nm), format_length(sweep.curve.front().threshold_nm),
        format_length(sweep.curve.back().threshold_nm), format_length(c.residual_nm),
        format_length(c.expected_nm), format_length(sweep.curve[sweep.jump].threshold_nm));
}

std::vector<std::filesystem::path> files_of(const TipArguments& o) {
  std::vector<std::filesystem::path> files{*o.output};
  if (o.plot) files.emplace_back(*o.plot);
  return files;
}

/// The tip, and its chart where one is asked for; both say how they were made.
void write_found(const TipArguments& o, const Tip& tip, io::Plot plot,
                 const std::map<std::string, std::string>& made) {
  io::write_tip(*o.output, tip, made);
  if (!o.plot) return;
  plot.metadata = made;
  io::write_plot(*o.plot, plot);
}

int by_shape(const TipArguments& o) {
  if (!o.scan.empty()) throw UsageError("--shape", "it takes no scan", "Leave out one of the two");
  auto parameters = o.told<workflow::TipShapeParameters>();
  const auto reading = o.told<io::HeightReadOptions>();
  if (reading.pitch_x_nm)
    parameters.pitch_x_nm = *reading.pitch_x_nm, parameters.pitch_y_nm = *reading.pitch_y_nm;
  const Tip tip = workflow::tip_by_shape(parameters);
  write_found(o, tip, tip_plot(tip),
              workflow::step_record("tip", workflow::records_of(parameters, reading)));
  if (o.quiet) return 0;
  print_tip(tip, depth_of(tip));
  print_written(files_of(o));
  return 0;
}

int by_characterizer(const TipArguments& o) {
  const std::vector<HeightField> scans = read_scans(o);
  if (scans.size() > 1)
    throw UsageError("--also", "a characterizer takes one scan", "Leave it out");
  auto parameters = o.told<workflow::CharacterizerParameters>();
  parameters.threads = threads_of(o.bound);
  const HeightField known = read_scan(*o.characterizer, {}, o.quiet).field;
  const CharacterizedTip found =
      workflow::tip_by_characterizer(scans[0], known, parameters, JobReporter(o.quiet));
  Record record = workflow::records_of(parameters, o.told<io::HeightReadOptions>());
  record["tip.answer"] = "characterizer";
  write_found(o, found.tip, tip_plot(found.tip),
              workflow::step_record("tip", record, {o.scan, *o.characterizer}));
  if (o.quiet) return 0;
  print("{:<10} found at sample ({}, {}) of the scan, {} above; residual {}\n", "known",
        found.offset_x, found.offset_y, format_length(found.offset_z_nm),
        format_length(found.residual_nm));
  print_tip(found.tip, std::max(height_range(scans).span_nm(), 1e-9));
  print_written(files_of(o));
  return 0;
}

io::Plot plot_of(const workflow::TipResult& found) {
  if (found.sweep) return tip_plot(*found.sweep);
  return found.best ? tip_plot(found.tip, *found.best) : tip_plot(found.tip);
}

void print_finding(const workflow::TipResult& found) {
  if (found.used.noise)
    print("{:<10} {}, alpha {:.2f}{}\n", "noise", format_length(found.sigma_nm),
          found.used.noise->alpha,
          found.noise_found ? ", from differences of neighbouring rows and columns" : "");
  if (found.sweep) print_sweep(*found.sweep);
  if (found.best)
    print("{:<10} misfit {:.2f} with {:.2f} free surface pixels per pixel, {} samples touched\n",
          "fit", found.best->chosen.misfit, found.best->chosen.freedom, found.best->touched);
  if (found.used.answer == workflow::TipAnswer::outer)
    print("{:<10} {}: at 95 % an outer bound\n", "threshold",
          format_length(*found.used.threshold_nm));
}

int from_scans(const TipArguments& o) {
  auto parameters = o.told<workflow::TipParameters>();
  parameters.threads = threads_of(o.bound);
  const std::vector<HeightField> scans = read_scans(o);
  const workflow::TipResult found = workflow::find_tip(scans, parameters, JobReporter(o.quiet));
  std::vector<std::filesystem::path> inputs{o.scan};
  inputs.insert(inputs.end(), o.also.begin(), o.also.end());
  write_found(
      o, found.tip, plot_of(found),
      workflow::step_record(
          "tip", workflow::records_of(found.used, o.told<io::HeightReadOptions>()), inputs));
  if (!o.quiet) {
    print_finding(found);
    print_tip(found.tip, std::max(height_range(scans).span_nm(), 1e-9));
    print_written(files_of(o));
  }
  return found.tip.doubt.empty() ? 0 : exit_untrustworthy;
}

int tip_work(const TipArguments& o) {
  if (!o.output) throw UsageError("--output", "no output file is given", "Add -o tip.gsf");
  io::check_height_field_target(*o.output);
  if (o.plot) io::check_plot_target(*o.plot);
  if (o.bound.is_given("tip.shape")) return by_shape(o);
  if (o.scan.empty())
    throw UsageError("tip", "no scan is given", "Name a file to read, or --shape");
  return o.characterizer ? by_characterizer(o) : from_scans(o);
}

}  // namespace

void add_tip(CLI::App& app, Action& action) {
  const auto o = std::make_shared<TipArguments>();
  CLI::App* sub =
      app.add_subcommand("tip", "Find the tip that made a scan, or make one by its shape");
  add_scan_input(*sub, o->bound, o->scan);
  with_role(sub->add_option("--also", o->also, "Another scan by the same tip; may be repeated")
                ->type_name("FILE"),
            FileRole::read);
  const char* tip = "Tip";
  o->bound.looks["tip.size"] = {
      .name = "--tip-size",
      .former = {"--size"},
      .help = fmt::format("Samples across the tip, odd; {} where --shape gives it",
                          workflow::TipShapeParameters{}.size)};
  o->bound.looks["scan.height_noise"].former = {"--noise"};
  o->bound.add<workflow::TipParameters>(*sub, tip, {},
                                        {"tip.size", "tip.answer", "scan.height_noise"});
  o->bound.add<workflow::TipShapeParameters>(*sub, tip, {}, {"tip.shape"});
  with_role(sub->add_option("--characterizer", o->characterizer,
                            "The known surface that the scan shows, as heights")
                ->type_name("FILE")
                ->group(tip),
            FileRole::read);
  o->bound.add<workflow::CharacterizerParameters>(*sub, tip, {}, {"tip.search"});
  o->bound.add<workflow::TipParameters>(*sub, "Blind reconstruction", {},
                                        {"tip.threshold", "tip.threshold_y", "tip.apex_tolerance",
                                         "tip.layer", "tip.maxima", "tip.sweep", "tip.seed"});
  const char* output = "Output";
  with_role(sub->add_option("-o,--output", o->output, "Tip to write: .gsf .tif .txt .vti")
                ->type_name("FILE")
                ->group(output),
            FileRole::written);
  with_role(sub->add_option("--plot", o->plot, "Chart of the choice and the tip: .svg .png")
                ->type_name("FILE")
                ->group(output),
            FileRole::written);
  add_threads_option(*sub, o->bound, output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(tip_examples);
  sub->callback([o, &action] { action = [o] { return tip_work(*o); }; });
}

}  // namespace surf::cli
