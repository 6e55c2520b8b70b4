// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "afm_masks.h"
#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "options.h"
#include "surf/afm/hough_plane.h"
#include "surf/afm/roughness.h"
#include "surf/afm/row_level.h"
#include "surf/afm/step_height.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "surf/workflow/afm_preparation.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(Methods:
  hough       the plane that most of the image lies on: the substrate under features
  plane       the mean plane (least squares)
  polynomial  of --degree, which takes the scanner's bow too
  none        leaves the heights as they are: to measure, or with --rows alone
With --rows the image is levelled, then its rows by what lies on the plane (hough), then once more.

Examples:
  semsurf level scan.gwy -o flat.gsf
  semsurf level scan.spm --rows median --mask substrate.tif -o flat.gsf
  semsurf level scan.gwy --method polynomial --degree 2 --exclude particles.png -o flat.tif
  semsurf level flat.gsf --method none --step 0,0,400,900 600,0,1000,900)";

struct Options {
  ScanInput scan;
  MaskInput masks;
  std::optional<std::string> output, mask, tolerance, rows, degree;
  std::string method = "hough";
  std::vector<std::string> step;
  bool quiet = false;
};

struct Plan {
  HoughOptions hough;
  int degree = workflow::AfmPreparationOptions{}.degree;
  std::optional<RowMethod> rows;
};

Plan make_plan(const Options& o) {
  if (o.scan.file.empty()) throw UsageError("level", "no scan is given", "Name a file to read");
  if (!o.output && o.step.empty())
    throw UsageError("--output", "no output file is given", "Add -o flat.gsf, or --step to measure only");
  if (std::string(" hough plane polynomial none ").find(" " + o.method + " ") == std::string::npos)
    throw UsageError("--method", fmt::format("there is no method '{}'", o.method),
                     "Choose hough, plane, polynomial or none");
  if (o.output) io::check_height_field_target(*o.output);
  if (o.mask) io::check_image_target(*o.mask);
  if (o.mask && o.method != "hough")
    throw UsageError("--mask", "only the method hough marks a substrate", "Leave out --mask, or --method");
  Plan p;
  if (o.tolerance) {
    if (o.method != "hough")
      throw UsageError("--tolerance", "only the method hough has one", "Leave out --tolerance, or --method");
    p.hough.tolerance_nm = parse_length_nm(*o.tolerance, "--tolerance");
    if (!(p.hough.tolerance_nm > 0))
      throw UsageError("--tolerance", fmt::format("'{}' is not above 0", *o.tolerance), "Give a length, as 0.5nm");
  }
  if (o.degree) {
    if (o.method != "polynomial")
      throw UsageError("--degree", "only a polynomial has one", "Add --method polynomial");
    p.degree = static_cast<int>(parse_whole(*o.degree, "--degree", 0, 6));
  }
  if (!o.rows) return p;
  if (*o.rows == "median") p.rows = RowMethod::median;
  else if (*o.rows == "difference") p.rows = RowMethod::difference;
  else throw UsageError("--rows", fmt::format("'{}' is no way to level rows", *o.rows), "Choose median or difference");
  return p;
}

void warn_of(const HoughSummary& s) {
  if (s.verdict == HoughVerdict::contested)
    print_warning(fmt::format("no plane holds a clear majority: another one, {} {} at the centre, holds {:.1f} % of "
                              "the image. Say which is meant with --use or --exclude",
                              format_length(std::fabs(s.runner_up.height_nm - s.plane.height_nm)),
                              s.runner_up.height_nm > s.plane.height_nm ? "higher" : "lower", 100 * s.runner_up_share));
  if (s.verdict == HoughVerdict::weak)
    print_warning(fmt::format("no plane stands out: the best one holds {:.1f} % of the image, chance alone {:.1f} %. "
                              "The surface is too rough for a substrate; --method plane may be what is wanted",
                              100 * s.inlier_share, 100 * s.chance_share));
  if (!s.search_complete)
    print_note("the search for planes ended at its limit: a better one, or a rival, may have been missed");
}

void print_plane(const Plane& plane) {
  print("{:<10} tilt {:.4g} deg, uphill at {:.3g} deg; slope {:.4g} along x, {:.4g} along y\n", "plane",
             plane.tilt_deg(), plane.uphill_deg(), plane.slope_x, plane.slope_y);
}

void print_inliers(const HoughSummary& s) {
  print("{:<10} {:.1f} % within {} of it, {} rms; the next plane holds {:.1f} %\n", "substrate",
             100 * s.inlier_share, format_length(s.tolerance_nm), format_length(s.inlier_rms_nm),
             100 * s.runner_up_share);
}

/// Levels by the method; returns what rows should go by.
Grid<unsigned char> level(HeightField& field, const Options& o, const Plan& plan, const Grid<unsigned char>& use,
                          bool report, Watched& watched, const Watch& watch) {
  if (o.method == "none") return use;
  if (o.method == "polynomial") {
    subtract(field, fit_polynomial(field, plan.degree, use));
    return use;
  }
  if (o.method == "plane") {
    const Plane plane = fit_plane(field, use);
    if (report && !o.quiet) print_plane(plane);
    subtract(field, plane);
    return use;
  }
  HoughOptions hough = plan.hough;
  hough.watch = watch;
  const HoughSummary s = find_plane(field, hough, use);
  watched.clear();
  if (report && !o.quiet) {
    print_plane(s.plane);
    print_inliers(s);
  }
  if (report) warn_of(s);
  subtract(field, s.plane);
  return s.inliers;
}

void print_roughness(const char* label, const char* part, const Roughness& r) {
  print("{:<10} {}: Sa {}, Sq {}, Sz {}; {:.2g} deg of tilt left, without it Sq {}\n", label, part,
             format_length(r.sa_nm), format_length(r.sq_nm), format_length(r.sz_nm), r.tilt.tilt_deg(),
             format_length(r.sq_levelled_nm));
}

void print_step(const HeightField& field, const std::vector<std::string>& step) {
  const StepHeight s = measure_step(field, parse_mask_region(step[0], "--step", field),
                                    parse_mask_region(step[1], "--step", field));
  print("{:<10} {:.6g} ± {:.2g} nm, the second region above the first; {} rms about two parallel planes\n", "step",
             s.height_nm, s.stderr_nm, format_length(s.residual_nm));
}

std::map<std::string, std::string> recorded(const Options& o) {
  std::map<std::string, std::string> r{{"method", o.method}};
  const auto add = [&](const char* name, const std::optional<std::string>& value) {
    if (value) r[name] = *value;
  };
  add("channel", o.scan.channel), add("z-unit", o.scan.z_unit), add("pixel-size", o.scan.pixel_size);
  add("tolerance", o.tolerance), add("rows", o.rows), add("degree", o.degree);
  return r;
}

int work(const Options& o) {
  const Plan plan = make_plan(o);
  HeightField field = read_scan(o.scan, o.quiet).field;
  const Grid<unsigned char> use = read_masks(o.masks, field);
  Watched watched(!o.quiet);
  Grid<unsigned char> substrate =
      level(field, o, plan, use, !plan.rows, watched, watched.watch(0, plan.rows ? 0.4 : 0.9));
  if (plan.rows) {
    const RowLevel rows = level_rows(field, *plan.rows, substrate);
    if (!o.quiet) {
      const auto [low, high] = std::minmax_element(rows.offsets_nm.begin(), rows.offsets_nm.end());
      print("{:<10} shifted by {:.4g} to {:.4g} nm{}\n", "rows", *low, *high,
                 rows.rows_without_samples
                     ? fmt::format("; {} without a sample to go by, as the nearest", rows.rows_without_samples) : "");
    }
    substrate = level(field, o, plan, use, true, watched, watched.watch(0.5, 0.9));
  }
  if (!o.quiet) {
    print_roughness("roughness", use.empty() ? "all" : "what counts", measure_roughness(field, use));
    if (o.method == "hough") print_roughness("", "substrate", measure_roughness(field, substrate));
  }
  if (!o.step.empty()) print_step(field, o.step);
  if (o.mask) write_mask(*o.mask, substrate, field);
  if (o.output) {
    std::vector<std::string> inputs{o.scan.file};
    for (const auto& mask : {o.masks.use, o.masks.exclude})
      if (mask) inputs.push_back(*mask);
    io::write_height_field(*o.output, field, provenance_of("level", recorded(o), inputs));
  }
  if (!o.quiet)
    for (const auto& file : {o.mask, o.output})
      if (file) print("{:<10} {}\n", "written", *file);
  return 0;
}

}  // namespace

void add_level(CLI::App& app, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("level", "Level an AFM scan; roughness and step heights");
  sub->group("Commands");
  add_scan_input(*sub, o->scan);
  const char* levelling = "Levelling";
  sub->add_option("--method", o->method, "What is taken off (hough)")
      ->type_name("hough|plane|polynomial|none")->group(levelling);
  sub->add_option("--tolerance", o->tolerance, "Half the thickness of the substrate (from the heights)")
      ->type_name("LENGTH")->group(levelling);
  sub->add_option("--degree", o->degree, "Of the polynomial, 0 to 6 (2)")->type_name("N")->group(levelling);
  sub->add_option("--rows", o->rows, "Take off steps between scan lines, by the median of each or of\n"
                                     "the differences to the one below")
      ->type_name("median|difference")->group(levelling);
  add_mask_input(*sub, o->masks);
  const char* output = "Output";
  sub->add_option("--step", o->step, "Height of the second region above the first, in nm from the\n"
                                     "scan's origin")
      ->type_name("X0,Y0,X1,Y1")->expected(2)->group(output);
  sub->add_option("--mask", o->mask, "Write where the substrate is: .tif .png .exr .vti")
      ->type_name("FILE")->group(output);
  add_surface_output(*sub, o->output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(examples);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
