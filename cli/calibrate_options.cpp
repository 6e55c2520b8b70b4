// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "common_options.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/core/words.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model_file.h"
#include "surf/io/scan_parameters.h"

namespace surf::cli {
namespace {

constexpr const char* examples =
    R"(IMAGE and the simulated images show the same surface, pixel on pixel. FILE:CHANNEL names a channel of an image.
Fits IMAGE = gain_SE * SE + gain_BSE * BSE + offset by least squares. The residual image has the channels
calibrated (the fit), residual (IMAGE less that), valid, and gain with --range: there IMAGE and the fit are
compared up to a gain that varies slowly, the ratio of their means over squares of twice that range.
Exit code 4: the gains cannot be trusted, and the warnings say why.

Examples:
  semsurf calibrate sem.tif --pixel-size 3nm --images simulated.exr -o calibration.json --residual residual.exr
  semsurf calibrate sem.tif surface.gsf --model si-1keV-3nm.json --folded sem-si-1keV-3nm.json -o calibration.json
  semsurf calibrate sem.tif:2 --images simulated.exr --fit SE --offset 12 -o calibration.json
  semsurf calibrate sem.png --pixel-size 2nm --images simulated.exr --ratio 0.4 --white 255 -o calibration.json)";

/// Names of one text with commas, and no list: it is given once.
class NamesField final : public Field {
 public:
  explicit NamesField(std::vector<std::string>& names) : names_(names) {}
  FieldKind kind() const override { return FieldKind::text; }
  bool given() const override { return !names_.empty(); }
  std::string text() const override {
    std::string text;
    for (const std::string& name : names_) text += (text.empty() ? "" : ",") + name;
    return text;
  }
  void read(std::string_view text, const std::string&) override {
    names_.clear();
    for (const std::string_view name : split(text, ",")) names_.emplace_back(name);
  }
  void clear() override { names_.clear(); }

 private:
  std::vector<std::string>& names_;
};

}  // namespace

void describe(ParameterVisitor& visit, CalibrateParameters& p) {
  const auto file = [&](auto& value, const char* name, const char* help, FileRole role, const char* form = "FILE") {
    visit(value, {.name = name, .help = help, .form = form, .recorded = false, .file = role});
  };
  file(p.image, "calibration.image", "The image of a microscope", FileRole::read);
  file(p.heights, "calibration.heights", "The surface that IMAGE shows, for a model", FileRole::read);
  file(p.images, "calibration.images", "Simulated images of the same surface, as of 'semsurf simulate'",
       FileRole::read);
  file(p.model, "calibration.model", "Model that images HEIGHTS, as of 'semsurf train'", FileRole::read, "FILE.json");
  visit(p.edge, {"mirror", "flat", "periodic"},
        {.name = "calibration.edge", .help = "Continuation of HEIGHTS outside"});
  describe_some(visit, p.reading,
                {{"scan.pixel_size", "Size of pixels, of files that do not say, 2nm or 2nmx3nm", "as they say"}});
  NamesField fit(p.fit);
  visit.visit({.name = "calibration.fit",
               .help = "Simulated channels to fit",
               .otherwise = "SE,BSE, those that are there",
               .form = "NAMES"},
              fit);
  visit(p.ratio,
        {.name = "calibration.ratio", .help = "Gain of the second channel over the first's, where it is known"});
  visit(p.offset, {.name = "calibration.offset", .help = "What the image shows without a signal, where it is known"});
  visit(p.black, {.name = "calibration.black", .help = "Level from which pixels downwards are saturated and left out"});
  visit(p.white, {.name = "calibration.white", .help = "Level from which pixels upwards are saturated and left out"});
  describe(visit, p.masks);
  visit(p.range_nm, {.name = "calibration.range", .help = "Half the width of squares over which the gain may vary",
                     .unit = Unit::nm, .limits = above(0), .otherwise = "it is constant"});
  file(p.output, "output", "The calibration: .json", FileRole::written);
  file(p.residual, "calibration.residual", "The fit and what it leaves: .exr .tif .vti .png", FileRole::written);
  file(p.folded, "calibration.folded", "The model with gains and offset in its coefficients (filter banks): .json",
       FileRole::written, "FILE.json");
  describe(visit, p.execution);
}

CalibratePlan make_calibrate_plan(const CalibrateParameters& o) {
  if (o.image.empty()) throw UsageError("calibrate", "no image is given", "Name the image of a microscope");
  if (!o.images && !o.model)
    throw UsageError("`calibration.images`", "there is nothing to compare with",
                     "Add `calibration.images=simulated.exr`, or HEIGHTS with `calibration.model=MODEL.json`");
  if (o.images && o.model)
    throw UsageError("`calibration.model`", "simulated images are given, too", "Leave one of them out");
  if (o.model.has_value() == o.heights.empty())
    throw UsageError(
        "HEIGHTS", o.model ? "a model needs the surface" : "simulated images need no surface",
        o.model ? "Name heights, pixel on pixel with IMAGE" : "Leave it out, or give `calibration.model` instead");
  if (o.folded && !o.model)
    throw UsageError("`calibration.folded`", "there is no model to fold into", "Add `calibration.model=MODEL.json`");
  if (!o.output && !o.residual)
    throw UsageError("`output`", "no output file is given", "Add -o calibration.json");
  CalibratePlan p;
  p.model.threads = o.execution.threads;
  p.model.edge = o.edge;
  if (o.folded) io::check_model_target(*o.folded);
  if (o.output) io::check_writable(*o.output);
  if (o.residual) io::check_image_target(*o.residual);
  p.pitch = {o.reading.pixel_x_nm, o.reading.pixel_y_nm};
  p.channels = o.fit;
  for (const std::string& name : o.fit)
    if (name.empty() || std::ranges::count(o.fit, name) > 1)
      throw UsageError("`calibration.fit`", "a channel is named twice, or not at all", "Give names, as SE,BSE");
  if (o.ratio) p.options.ratios = {1, *o.ratio};
  p.options.offset = o.offset;
  p.options.black = o.black.value_or(p.options.black);
  p.options.white = o.white.value_or(p.options.white);
  if (!(p.options.black < p.options.white))
    throw UsageError("`calibration.white`", "it is not above `calibration.black`", "Exchange the two levels");
  p.range_nm = o.range_nm.value_or(0);
  return p;
}

void add_calibrate_options(CLI::App& app, CalibrateOptions& o) {
  const char *options = "Options", *fitting = "Fit", *output = "Output";
  o.bound.headings = {{"calibration", fitting},
                      {"calibration.image", options},
                      {"calibration.heights", options},
                      {"calibration.images", options},
                      {"calibration.model", options},
                      {"calibration.edge", options},
                      {"scan", fitting},
                      {"scan.pixel_size", options},
                      {"calibration.range", output},
                      {"output", output},
                      {"calibration.residual", output},
                      {"calibration.folded", output},
                      {"job", output}};
  o.bound.looks["calibration.image"] = {.name = "IMAGE", .positional = true};
  o.bound.looks["calibration.heights"] = {.name = "HEIGHTS", .positional = true};
  o.bound.looks["output"] = {.name = "-o,--output"};
  o.bound.add<CalibrateParameters>(app, "");
  add_quiet_flag(app, o.quiet)->group(output);
  app.footer(examples);
}

}  // namespace surf::cli
