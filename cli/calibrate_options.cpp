// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate_options.h"

#include "common_options.h"
#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model/model_file.h"
#include "surf/io/scan_parameters.h"

namespace surf::cli {
namespace {

constexpr const char* calibrate_options_examples =
    R"(IMAGE and the simulated images show the same surface, pixel on pixel. FILE:CHANNEL names a channel of an image.
Fits IMAGE = gain_SE * SE + gain_BSE * BSE + offset by least squares. The residual image has the channels
calibrated (the fit), residual (IMAGE less that), valid, and gain with --range: there IMAGE and the fit are
compared up to a gain that varies slowly, the ratio of their means over squares of twice that range.
Exit code 4: the gains cannot be trusted, and the warnings say why.

Examples:
  semsurf calibrate sem.tif --pixel-size 3nm --images simulated.exr -o calibration.json --residual residual.exr
  semsurf calibrate sem.tif surface.gsf --model bank.json --folded sem-bank.json -o calibration.json
  semsurf calibrate sem.exr:SE --images simulated.exr --fit SE --offset 12 -o calibration.json
  semsurf calibrate sem.png --pixel-size 2nm --images simulated.exr --ratio 0.4 --white 255 -o calibration.json)";

}  // namespace

void describe(ParameterVisitor& visit, CalibrateFiles& p) {
  const auto file = [&](auto& value, const char* name, const char* help, FileRole role,
                        const char* form = "FILE") {
    visit(value, {.name = name, .help = help, .form = form, .recorded = false, .file = role});
  };
  file(p.image, "calibration.image", "The image of a microscope", FileRole::read);
  file(p.heights, "calibration.heights", "The surface that IMAGE shows, for a model",
       FileRole::read);
  file(p.images, "calibration.images",
       "Simulated images of the same surface, as of 'semsurf simulate'", FileRole::read);
  file(p.model, "calibration.model", "Model that images HEIGHTS, as of 'semsurf train'",
       FileRole::read, "FILE.json");
  describe_some(visit, p.reading,
                {{"scan.pixel_size", "Size of pixels, of files that do not say, 2nm or 2nmx3nm",
                  "as they say"}});
  describe(visit, p.masks);
  file(p.output, "output", "The calibration: .json", FileRole::written);
  file(p.residual, "calibration.residual", "The fit and what it leaves: .exr .tif .vti .png",
       FileRole::written);
  file(p.folded, "calibration.folded",
       "The model with gains and offset in its coefficients (filter banks): .json",
       FileRole::written, "FILE.json");
  describe(visit, p.execution);
}

void check(const CalibrateFiles& o, const workflow::CalibrateParameters& parameters) {
  if (o.image.empty())
    throw UsageError("calibrate", "no image is given", "Name the image of a microscope");
  if (!o.images && !o.model)
    throw UsageError(
        "`calibration.images`", "there is nothing to compare with",
        "Add `calibration.images=simulated.exr`, or HEIGHTS with `calibration.model=MODEL.json`");
  if (o.images && o.model)
    throw UsageError("`calibration.model`", "simulated images are given, too",
                     "Leave one of them out");
  if (o.model.has_value() == o.heights.empty())
    throw UsageError("HEIGHTS",
                     o.model ? "a model needs the surface" : "simulated images need no surface",
                     o.model ? "Name heights, pixel on pixel with IMAGE"
                             : "Leave it out, or give `calibration.model` instead");
  if (o.folded && !o.model)
    throw UsageError("`calibration.folded`", "there is no model to fold into",
                     "Add `calibration.model=MODEL.json`");
  if (!o.output && !o.residual)
    throw UsageError("`output`", "no output file is given", "Add -o calibration.json");
  if (o.folded) io::check_model_target(*o.folded);
  if (o.output) io::check_writable(*o.output);
  if (o.residual) io::check_image_target(*o.residual);
  workflow::check(parameters);
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
  o.bound.add<CalibrateFiles>(app, "");
  o.bound.add<workflow::CalibrateParameters>(app, "");
  add_quiet_flag(app, o.quiet)->group(output);
  app.footer(calibrate_options_examples);
}

}  // namespace surf::cli
