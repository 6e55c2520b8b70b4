// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "afm_masks.h"
#include "afm_options.h"
#include "commands.h"
#include "common_options.h"
#include "job_reporter.h"
#include "scan_batch.h"
#include "surf/afm/roughness.h"
#include "surf/afm/step_height.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/image_file.h"
#include "surf/workflow/level_job.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::LevelMethod, workflow::LevelParameters;

constexpr const char* level_examples =
    R"(Methods:
  hough       the plane that most of the image lies on: the substrate under features
  plane       the mean plane (least squares)
  polynomial  of --level-degree, which takes the scanner's bow too
  none        leaves the heights as they are: to measure, or with --rows alone
With --rows the image is levelled, then its rows by what lies on the plane (hough), then once more.

Examples:
  semsurf level scan.gwy -o flat.gsf
  semsurf level scans/*.spm -o flat/                    each to flat/NAME.gsf
  semsurf level scan.spm --rows median --substrate-mask substrate.tif -o flat.gsf
  semsurf level scan.gwy --level-method polynomial --level-degree 2 --exclude particles.png -o flat.tif
  semsurf level flat.gsf --level-method none --step 0,0,400,900 600,0,1000,900)";

struct LevelArguments {
  BoundParameters bound;
  std::vector<std::string> scans;
  std::optional<std::string> output, substrate_mask;
  std::vector<std::string> step;
  bool quiet = false;
};

void refuse_contradictions(const LevelArguments& o, const LevelParameters& p) {
  if (!o.output && o.step.empty())
    throw UsageError("--output", "no output file is given",
                     "Add -o flat.gsf, or --step to measure only");
  if (o.substrate_mask && p.method != LevelMethod::hough)
    throw UsageError("--substrate-mask", "only the method hough marks a substrate",
                     "Leave out --substrate-mask, or --level-method");
  if (o.bound.is_given("level.degree") && p.method != LevelMethod::polynomial)
    throw UsageError("--level-degree", "only a polynomial has one",
                     "Add --level-method polynomial");
}

void print_plane(const Plane& plane) {
  print("{:<10} tilt {:.4g} deg, uphill at {:.3g} deg; slope {:.4g} along x, {:.4g} along y\n",
        "plane", plane.tilt_deg(), plane.uphill_deg(), plane.slope_x, plane.slope_y);
}

void print_rows(const RowLevel& rows) {
  const auto [low, high] = std::minmax_element(rows.offsets_nm.begin(), rows.offsets_nm.end());
  print("{:<10} shifted by {:.4g} to {:.4g} nm{}\n", "rows", *low, *high,
        rows.rows_without_samples ? fmt::format("; {} without a sample to go by, as the nearest",
                                                rows.rows_without_samples)
                                  : "");
}

void print_inliers(const HoughSummary& s) {
  print("{:<10} {:.1f} % within {} of it, {} rms; the next plane holds {:.1f} %\n", "substrate",
        100 * s.inlier_share, format_length(s.tolerance_nm), format_length(s.inlier_rms_nm),
        100 * s.runner_up_share);
}

void print_roughness(const char* label, const char* part, const Roughness& r) {
  constexpr double rounding_deg = 1e-9;
  const double tilt = r.tilt.tilt_deg() < rounding_deg ? 0 : r.tilt.tilt_deg();
  print("{:<10} {}: Sa {}, Sq {}, Sz {}; {:.2g} deg of tilt left, without it Sq {}\n", label, part,
        format_length(r.sa_nm), format_length(r.sq_nm), format_length(r.sz_nm), tilt,
        format_length(r.sq_levelled_nm));
}

void print_step(const HeightField& field, const std::vector<std::string>& step) {
  const StepHeight s = measure_step(field, parse_mask_region(step[0], "--step", field),
                                    parse_mask_region(step[1], "--step", field));
  print(
      "{:<10} {:.6g} ± {:.2g} nm, the second region above the first; {} rms about two parallel "
      "planes\n",
      "step", s.height_nm, s.stderr_nm, format_length(s.residual_nm));
}

struct Levelling {
  LevelParameters parameters;
  io::HeightReadOptions reading;
  MaskInput masks;
};

void level(const LevelArguments& o, const Levelling& l, const BatchStep& file) {
  const HeightField scan = read_scan(file.scan, l.reading, o.quiet).field;
  const Mask use = read_masks(l.masks, scan);
  const workflow::LevelResult levelled =
      workflow::level(scan, l.parameters, use, JobReporter(o.quiet));
  const HeightField& field = levelled.field;
  if (!o.quiet) {
    if (file.one_of_many) print("{}\n", file.scan);
    if (levelled.rows) print_rows(*levelled.rows);
    if (levelled.plane) print_plane(*levelled.plane);
    if (levelled.hough) print_inliers(*levelled.hough);
    print_roughness("roughness", use.empty() ? "all" : "what counts",
                    measure_roughness(field, use));
    if (levelled.hough)
      print_roughness("", "substrate", measure_roughness(field, levelled.substrate));
  }
  if (!o.step.empty()) print_step(field, o.step);
  if (o.substrate_mask || file.output) {
    std::vector<std::filesystem::path> inputs{file.scan};
    for (const std::string& mask : l.masks.files()) inputs.emplace_back(mask);
    const auto made = workflow::step_record(
        "level", workflow::records_of(l.parameters, l.reading, l.masks), inputs);
    if (o.substrate_mask) write_mask(*o.substrate_mask, levelled.substrate, field, made);
    if (file.output) io::write_height_field(*file.output, field, made);
  }
  if (o.quiet) return;
  for (const auto& written : {o.substrate_mask, file.output})
    if (written) print("{:<10} {}\n", "written", *written);
  flush();
}

int level_work(const LevelArguments& o) {
  Levelling l;
  o.bound.apply(l.parameters), o.bound.apply(l.reading), o.bound.apply(l.masks);
  refuse_contradictions(o, l.parameters);
  const std::vector<BatchStep> batch = batch_of(o.scans, o.output, "level");
  if (o.substrate_mask && batch.size() > 1)
    throw UsageError("--substrate-mask", "one file does not hold the masks of several scans",
                     "Leave it out, or level the scans one by one");
  if (o.substrate_mask) io::check_image_target(*o.substrate_mask);
  return for_each_scan(batch, [&](const BatchStep& file) { level(o, l, file); });
}

}  // namespace

void add_level(CLI::App& app, Action& action) {
  const auto o = std::make_shared<LevelArguments>();
  CLI::App* sub = app.add_subcommand("level", "Level an AFM scan; roughness and step heights");
  add_scan_inputs(*sub, o->bound, o->scans);
  o->bound.looks["level.method"] = {.name = "--level-method", .former = {"--method"}};
  o->bound.looks["level.degree"] = {.name = "--level-degree", .former = {"--degree"}};
  o->bound.looks["level.tolerance"] = {.name = "--level-tolerance", .former = {"--tolerance"}};
  o->bound.add<LevelParameters>(*sub, "Levelling");
  o->bound.add<MaskInput>(*sub, "Samples that decide");
  const char* output = "Output";
  sub->add_option("--step", o->step,
                  "Height of the second region above the first, in nm from the\n"
                  "scan's origin")
      ->type_name("X0,Y0,X1,Y1")
      ->expected(2)
      ->group(output);
  with_role(sub->add_option("--substrate-mask", o->substrate_mask,
                            "Image of where the substrate is: .tif .png .exr .vti")
                ->type_name("FILE")
                ->group(output),
            FileRole::written);
  with_role(sub->add_option("--mask", o->substrate_mask)->type_name("FILE")->group(""),
            FileRole::written);  // its former name
  add_surface_output(*sub, o->output);
  add_quiet_flag(*sub, o->quiet)->group(output);
  sub->footer(level_examples);
  sub->callback([o, &action] { action = [o] { return level_work(*o); }; });
}

}  // namespace surf::cli
