// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "afm_masks.h"
#include "calibrate_options.h"
#include "commands.h"
#include "exit_codes.h"
#include "job_reporter.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/model/calibration_file.h"
#include "surf/io/model/model_file.h"
#include "surf/workflow/calibrate_job.h"
#include "surf/workflow/picture_input.h"
#include "surf/workflow/predict_job.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using workflow::CalibrateInput;
using workflow::CalibrateParameters;

/// What a model gives for the heights, with a note of how these were read.
Image predicted(const CalibrateFiles& o, const CalibrateParameters& p,
                const workflow::Reporter& reporter) {
  workflow::PredictJob job;
  job.model = *o.model;
  job.input = o.heights;
  job.edge = p.edge;
  job.threads = o.execution.threads;
  io::HeightFieldFile scan =
      io::read_height_field(o.heights, {{}, {}, o.reading.pixel_x_nm, o.reading.pixel_y_nm});
  for (const std::string& note : scan.notes) reporter.note(fmt::format("{}: {}", o.heights, note));
  job.field = std::move(scan.field);
  return workflow::run(job, reporter).image;
}

/// A filter bank in the image's own units.
void write_folded(const std::string& path, TrainedModel trained, const Calibration& c,
                  const std::map<std::string, std::string>& made) {
  trained.parameters = fold(c, std::get<FilterBankParameters>(trained.parameters));
  trained.record.residuals.clear();  // they are of the channels before
  trained.record.held_out_residuals.clear();
  for (TrainingScene& scene : trained.record.scenes) scene.residuals.clear();
  for (const auto& [key, value] : made) trained.record.notes["calibration." + key] = value;
  io::write_model(path, trained);
}

CalibrateInput read_input(const CalibrateFiles& o) {
  const workflow::FileChannel file = workflow::parse_file_channel(o.image);
  const io::WebImage picture =
      workflow::read_picture(file, {o.reading.pixel_x_nm, o.reading.pixel_y_nm});
  if (!picture.has_scale)
    throw InvalidInput(o.image, "it does not say how large its pixels are",
                       "Give their size, as `scan.pixel_size=2nm`");
  const Image& image = picture.image;
  const Channel* channel = file.channel.empty() ? nullptr : image.find(file.channel);
  if (!channel) channel = &image.channels.front();  // the first, or by number
  const Channel* const valid = image.find("valid");
  CalibrateInput input;
  input.name = o.image;
  input.image = {image.placement(), Grid<double>(image.width(), image.height())};
  for (std::size_t i = 0; i < input.image.values.size(); ++i)
    input.image.values.data()[i] =
        valid && valid->values.data()[i] == 0 ? NAN : double{channel->values.data()[i]};
  HeightField place;
  place.z_nm = input.image.values;
  place.placement() = image.placement();
  input.image.valid = read_masks(o.masks, place);
  return input;
}

void write_residual(const std::string& path, const PlacedImage& like,
                    const workflow::CalibrateResult& result,
                    const std::map<std::string, std::string>& made) {
  Image out;
  out.placement() = like.placement();
  out.metadata = made;
  const Grid<float> none(like.values.width(), like.values.height());
  out.channels = {{"calibrated", "1", none}, {"residual", "1", none}, {"valid", "1", none}};
  if (!result.gain.empty()) out.channels.push_back({"gain", "1", none});
  for (std::size_t i = 0; i < result.fit.size(); ++i) {
    if (!std::isfinite(result.residual.data()[i])) continue;
    out.channels[0].values.data()[i] = static_cast<float>(result.fit.data()[i]);
    out.channels[1].values.data()[i] = static_cast<float>(result.residual.data()[i]);
    out.channels[2].values.data()[i] = 1;
    if (!result.gain.empty())
      out.channels[3].values.data()[i] = static_cast<float>(result.gain.data()[i]);
  }
  io::write_image(path, out);
}

void print_fit(const Calibration& c) {
  const bool known = c.outcome != CalibrationOutcome::undetermined;
  for (std::size_t i = 0; i < c.channels.size(); ++i)
    print("{:<10} {:.6g}{}\n", "gain " + c.channels[i], c.gains[i],
          known ? fmt::format(" ± {:.2g}", c.gain_stderr(i)) : ", one of many");
  print("{:<10} {:.6g}{}\n", "offset", c.offset,
        c.offset_stderr() == 0 ? ""
        : known                ? fmt::format(" ± {:.2g}", c.offset_stderr())
                               : ", one of many");
  print("{:<10} {}\n", "condition", known ? fmt::format("{:.4g}", c.condition_number) : "infinite");
  print("{:<10} {:.4g} rms, {:.2f} % of the variance explained; correlation of neighbours {:.2f}\n",
        "residual", c.residual_rms, 100 * c.explained, c.residual_correlation);
  print("{:<10} {}{}\n", "pixels", c.pixels,
        c.saturated ? fmt::format("; {} saturated ones left out", c.saturated) : "");
}

std::map<std::string, std::string> record(const CalibrateFiles& o, const CalibrateParameters& p) {
  std::vector<std::filesystem::path> inputs{workflow::parse_file_channel(o.image).file};
  if (o.model) inputs.emplace_back(o.heights);
  for (const auto& input : {o.images, o.model, o.masks.use, o.masks.exclude})
    if (input) inputs.emplace_back(*input);
  return workflow::step_record("calibrate", workflow::records_of(o, p), inputs);
}

int calibrate_work(const CalibrateOptions& options) {
  CalibrateFiles o;
  CalibrateParameters parameters;
  options.bound.apply(o), options.bound.apply(parameters);
  check(o, parameters);
  CalibrateInput input = read_input(o);
  std::optional<TrainedModel> model;
  if (o.folded) model = io::read_model(*o.model);
  if (model && !std::holds_alternative<FilterBankParameters>(model->parameters))
    throw UsageError("`calibration.folded`", "gains fold into filter banks only",
                     "Keep the calibration beside the model");
  workflow::CalibrateResult result;
  {
    const JobReporter reporter(options.quiet);
    input.simulated = o.model ? predicted(o, parameters, reporter) : io::read_image(*o.images);
    input.simulated_name = o.model ? o.heights : *o.images;
    result = workflow::calibrate(input, parameters, reporter);
  }
  const Calibration& c = result.calibration;
  const auto made = record(o, parameters);
  if (!options.quiet) print_fit(c);
  if (o.residual) write_residual(*o.residual, input.image, result, made);
  if (o.output) io::write_calibration(*o.output, {c, parameters.range_nm.value_or(0), made});
  if (o.folded) write_folded(*o.folded, *model, c, made);
  if (!options.quiet)
    for (const auto& file : {o.output, o.residual, o.folded})
      if (file) print("{:<10} {}\n", "written", *file);
  return result.trusted() ? 0 : exit_untrustworthy;
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  const auto o = std::make_shared<CalibrateOptions>();
  CLI::App* sub = app.add_subcommand("calibrate",
                                     "Gains and offset that turn simulated images into a real one");
  add_calibrate_options(*sub, *o);
  sub->callback([o, &action] { action = [o] { return calibrate_work(*o); }; });
}

}  // namespace surf::cli
