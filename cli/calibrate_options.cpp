// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "common_options.h"
#include "options.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model_file.h"

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

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream in(text);
  for (std::string name; std::getline(in, name, ',');) {
    if (name.empty() || std::ranges::count(names, name))
      throw UsageError("--fit", fmt::format("'{}' names a channel twice, or none", text),
                       "Give names, as SE,BSE");
    names.push_back(name);
  }
  return names;
}

}  // namespace

CalibratePlan make_calibrate_plan(const CalibrateOptions& o) {
  if (o.image.empty()) throw UsageError("calibrate", "no image is given", "Name the image of a microscope");
  if (!o.images && !o.model)
    throw UsageError("--images", "there is nothing to compare with",
                     "Add --images simulated.exr, or HEIGHTS with --model MODEL.json");
  if (o.images && o.model)
    throw UsageError("--model", "simulated images are given, too", "Leave one of them out");
  if (o.model.has_value() == o.heights.empty())
    throw UsageError(
        "HEIGHTS", o.model ? "a model needs the surface" : "simulated images need no surface",
        o.model ? "Name heights, pixel on pixel with IMAGE" : "Leave it out, or give --model instead");
  if (o.folded && !o.model)
    throw UsageError("--folded", "there is no model to fold into", "Add --model MODEL.json");
  if (!o.output && !o.residual)
    throw UsageError("--output", "no output file is given", "Add -o calibration.json");
  CalibratePlan p;
  p.model.threads = parse_threads(o.threads);
  if (o.edge) p.model.edge = parse_edge(*o.edge, "--edge");
  if (o.folded) io::check_model_target(*o.folded);
  if (o.output) io::check_writable(*o.output);
  if (o.residual) io::check_image_target(*o.residual);
  if (o.pixel_size) std::tie(p.pitch.x_nm, p.pitch.y_nm) = parse_pixel_size(*o.pixel_size, "--pixel-size");
  if (o.fit) p.channels = split_names(*o.fit);
  if (o.ratio) p.options.ratios = {1, parse_number(*o.ratio, "--ratio")};
  if (o.offset) p.options.offset = parse_number(*o.offset, "--offset");
  if (o.black) p.options.black = parse_number(*o.black, "--black");
  if (o.white) p.options.white = parse_number(*o.white, "--white");
  if (!(p.options.black < p.options.white))
    throw UsageError("--white", "it is not above --black", "Exchange the two levels");
  if (!o.range) return p;
  p.range_nm = parse_length_nm(*o.range, "--range");
  if (!(p.range_nm > 0))
    throw UsageError("--range", fmt::format("'{}' is not above 0", *o.range), "Give a length, as 500nm");
  return p;
}

std::map<std::string, std::string> recorded(const CalibrateOptions& o) {
  std::map<std::string, std::string> r;
  const auto add = [&](const char* name, const std::optional<std::string>& value) {
    if (value) r[name] = *value;
  };
  add("pixel-size", o.pixel_size), add("fit", o.fit), add("ratio", o.ratio), add("offset", o.offset);
  add("black", o.black), add("white", o.white), add("range", o.range), add("edge", o.edge);
  return r;
}

void add_calibrate_options(CLI::App& app, CalibrateOptions& o) {
  app.add_option("IMAGE", o.image, "The image of a microscope")->type_name("FILE");
  app.add_option("HEIGHTS", o.heights, "With --model: the surface that IMAGE shows")->type_name("FILE");
  app.add_option("--images", o.images, "Simulated images of the same surface, as of 'semsurf simulate'")
      ->type_name("FILE");
  app.add_option("--model", o.model, "Instead: a model that images HEIGHTS, as of 'semsurf train'")
      ->type_name("FILE.json");
  app.add_option("--edge", o.edge, "How HEIGHTS go on outside (mirror)")->type_name("mirror|flat|periodic");
  app.add_option("--pixel-size", o.pixel_size, "Of files that do not say, 2nm or 2nmx3nm")
      ->type_name("LENGTH");
  const char* fitting = "Fit";
  app.add_option("--fit", o.fit, "Which simulated channels (SE,BSE, those that are there)")
      ->type_name("NAMES")->group(fitting);
  app.add_option("--ratio", o.ratio, "Gain of the second channel over the first's, where it is known")
      ->type_name("NUMBER")->group(fitting);
  app.add_option("--offset", o.offset, "What the image shows without a signal, where it is known")
      ->type_name("NUMBER")->group(fitting);
  app.add_option("--black", o.black, "Levels from here down are saturated and left out")
      ->type_name("NUMBER")->group(fitting);
  app.add_option("--white", o.white, "Levels from here up are saturated and left out")
      ->type_name("NUMBER")->group(fitting);
  add_mask_input(app, o.masks);
  const char* output = "Output";
  app.add_option("--range", o.range,
                 "Half the width of squares over which the gain may vary (it is constant)")
      ->type_name("LENGTH")
      ->group(output);
  app.add_option("-o,--output", o.output, "The calibration: .json")->type_name("FILE")->group(output);
  app.add_option("--residual", o.residual, "The fit and what it leaves: .exr .tif .vti .png")
      ->type_name("FILE")->group(output);
  app.add_option("--folded", o.folded,
                 "The model with gains and offset in its coefficients (filter banks): .json")
      ->type_name("FILE.json")
      ->group(output);
  add_threads_option(app, o.threads)->group(output);
  add_quiet_flag(app, o.quiet)->group(output);
  app.footer(examples);
}

}  // namespace surf::cli
