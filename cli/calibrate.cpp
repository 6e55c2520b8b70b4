// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "afm_masks.h"
#include "calibrate_options.h"
#include "commands.h"
#include "exit_codes.h"
#include "picture_input.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/calibration_file.h"
#include "surf/io/files.h"
#include "surf/io/image_file.h"
#include "surf/io/model_file.h"
#include "surf/io/height_field_file.h"
#include "surf/workflow/step_record.h"
#include "terminal.h"

namespace surf::cli {
namespace {

constexpr double same_pitch = 1e-3;   // relative: as models ask of fields

void check_same_pixels(const Image& real, const Image& simulated, const CalibrateParameters& o) {
  const std::string& other = o.images ? *o.images : o.heights;
  constexpr const char* remedy = "They have to show the same surface pixel on pixel: register and resample one first";
  if (real.width() != simulated.width() || real.height() != simulated.height())
    throw InvalidInput(o.image, fmt::format("it has {} x {} pixels, {} has {} x {}", real.width(), real.height(),
                                            other, simulated.width(), simulated.height()), remedy);
  const auto differ = [](double a, double b) { return std::fabs(a - b) > same_pitch * b; };
  if (differ(real.pitch_x_nm, simulated.pitch_x_nm) || differ(real.pitch_y_nm, simulated.pitch_y_nm))
    throw InvalidInput(o.image, fmt::format("its pixels are {:.6g} x {:.6g} nm, those of {} {:.6g} x {:.6g} nm",
                                            real.pitch_x_nm, real.pitch_y_nm, other, simulated.pitch_x_nm,
                                            simulated.pitch_y_nm), remedy);
}

Grid<double> values(const Image& image, const Channel& channel) {
  const Channel* valid = image.find("valid");
  Grid<double> out(image.width(), image.height());
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] = valid && valid->values.data()[i] == 0 ? NAN : double{channel.values.data()[i]};
  return out;
}

void add_channels(CalibrationImages& images, const Image& simulated, const CalibratePlan& p, const std::string& file) {
  std::vector<std::string> wanted = p.channels;
  if (wanted.empty())
    for (const char* usual : {"SE", "BSE"})
      if (simulated.find(usual)) wanted.emplace_back(usual);
  if (wanted.empty())
    throw UsageError(file, "it has no channel SE or BSE", "Say which of its channels to fit with --fit");
  if (!p.options.ratios.empty() && wanted.size() != 2)
    throw UsageError("`calibration.ratio`", fmt::format("it is of two channels, not of {}", wanted.size()),
                     "Fit two channels, or leave it out");
  for (const std::string& name : wanted) {
    const Channel* channel = simulated.find(name);
    if (!channel) {
      std::vector<std::string> names;
      for (const Channel& c : simulated.channels) names.push_back(c.name);
      throw UsageError("`calibration.fit`", fmt::format("{} has no channel '{}'", file, name),
                       fmt::format("Choose of: {}", fmt::join(names, ", ")));
    }
    images.channels.push_back(name);
    images.simulated.push_back(values(simulated, *channel));
  }
}

Image predicted(const CalibrateParameters& o, const CalibratePlan& p, const TrainedModel& trained, bool quiet) {
  const io::HeightFieldFile scan = io::read_height_field(o.heights, {{}, {}, p.pitch.x_nm, p.pitch.y_nm});
  if (!quiet)
    for (const std::string& note : scan.notes) print_note(fmt::format("{}: {}", o.heights, note));
  check_field(trained.scope, scan.field, o.heights.c_str());
  const auto model = make_model(trained);
  const ModelImages images = model->predict(scan.field, p.model);
  Image out;
  out.pitch_x_nm = scan.field.pitch_x_nm, out.pitch_y_nm = scan.field.pitch_y_nm;
  for (std::size_t c = 0; c < images.size(); ++c) {
    out.channels.push_back({model->channels()[c], "1", Grid<float>(images[c].width(), images[c].height())});
    for (std::size_t i = 0; i < images[c].size(); ++i)
      out.channels.back().values.data()[i] = static_cast<float>(images[c].data()[i]);
  }
  return out;
}

/// A filter bank in the image's own units.
void write_folded(const std::string& path, TrainedModel trained, const Calibration& c,
                  const std::map<std::string, std::string>& made) {
  trained.parameters = fold(c, std::get<FilterBankParameters>(trained.parameters));
  trained.record.residuals.clear();   // they are of the channels before
  trained.record.held_out_residuals.clear();
  for (TrainingScene& scene : trained.record.scenes) scene.residuals.clear();
  for (const auto& [key, value] : made) trained.record.notes["calibration." + key] = value;
  io::write_model(path, trained);
}

Image read_real(const CalibrateParameters& o, const CalibratePlan& p, Grid<double>& real) {
  const FileChannel input = parse_file_channel(o.image);
  io::WebImage picture = read_picture(input, p.pitch);
  if (!picture.has_scale)
    throw InvalidInput(o.image, "it does not say how large its pixels are", "Give their size with --pixel-size");
  const Channel* channel = input.channel.empty() ? &picture.image.channels.front() : picture.image.find(input.channel);
  if (!channel) channel = &picture.image.channels.front();   // by number
  real = values(picture.image, *channel);
  return std::move(picture.image);
}

void write_residual(const std::string& path, const Image& like, const CalibrationImages& images,
                    const Calibration& c, double range_nm, const std::map<std::string, std::string>& made) {
  Grid<double> fit = calibrated_image(c, images.simulated);
  SlowGain slow;
  if (range_nm > 0) {
    slow = slow_gain(images.real, fit, static_cast<int>(std::min(range_nm / like.pitch_x_nm, 1e9)),
                     static_cast<int>(std::min(range_nm / like.pitch_y_nm, 1e9)), images.used);
    if (slow.unknown)
      print_warning(fmt::format("{} pixels have nothing around them to take a gain from: they are not valid in {}",
                                slow.unknown, path));
    for (std::size_t i = 0; i < fit.size(); ++i) fit.data()[i] *= slow.gain.data()[i];
  }
  Image out;
  out.pitch_x_nm = like.pitch_x_nm, out.pitch_y_nm = like.pitch_y_nm;
  out.origin_x_nm = like.origin_x_nm, out.origin_y_nm = like.origin_y_nm;
  out.metadata = made;
  const Grid<float> none(like.width(), like.height());
  out.channels = {{"calibrated", "1", none}, {"residual", "1", none}, {"valid", "1", none}};
  if (range_nm > 0) out.channels.push_back({"gain", "1", none});
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const bool known = range_nm <= 0 || slow.known.data()[i];
    if (!known || !std::isfinite(fit.data()[i]) || !std::isfinite(images.real.data()[i])) continue;
    out.channels[0].values.data()[i] = static_cast<float>(fit.data()[i]);
    out.channels[1].values.data()[i] = static_cast<float>(images.real.data()[i] - fit.data()[i]);
    out.channels[2].values.data()[i] = 1;
    if (range_nm > 0) out.channels[3].values.data()[i] = static_cast<float>(slow.gain.data()[i]);
  }
  io::write_image(path, out);
}

void print_fit(const Calibration& c) {
  const bool known = c.outcome != CalibrationOutcome::undetermined;
  for (std::size_t i = 0; i < c.channels.size(); ++i)
    print("{:<10} {:.6g}{}\n", "gain " + c.channels[i], c.gains[i],
               known ? fmt::format(" ± {:.2g}", c.gain_stderr(i)) : ", one of many");
  print("{:<10} {:.6g}{}\n", "offset", c.offset,
             c.offset_stderr() == 0 ? "" : known ? fmt::format(" ± {:.2g}", c.offset_stderr()) : ", one of many");
  print("{:<10} {}\n", "condition", known ? fmt::format("{:.4g}", c.condition_number) : "infinite");
  print("{:<10} {:.4g} rms, {:.2f} % of the variance explained; correlation of neighbours {:.2f}\n", "residual",
             c.residual_rms, 100 * c.explained, c.residual_correlation);
  print("{:<10} {}{}\n", "pixels", c.pixels, c.saturated ? fmt::format("; {} saturated ones left out", c.saturated) : "");
}

int work(const CalibrateOptions& options) {
  CalibrateParameters o;
  options.bound.apply(o);
  const CalibratePlan plan = make_calibrate_plan(o);
  CalibrationImages images;
  const Image real = read_real(o, plan, images.real);
  std::optional<TrainedModel> model;
  if (o.model) model = io::read_model(*o.model);
  if (o.folded && !std::holds_alternative<FilterBankParameters>(model->parameters))
    throw UsageError("`calibration.folded`", "gains fold into filter banks only",
                     "Keep the calibration beside the model");
  const Image simulated = model ? predicted(o, plan, *model, options.quiet) : io::read_image(*o.images);
  check_same_pixels(real, simulated, o);
  add_channels(images, simulated, plan, model ? *o.model : *o.images);
  HeightField place;
  place.z_nm = images.real;
  place.pitch_x_nm = real.pitch_x_nm, place.pitch_y_nm = real.pitch_y_nm;
  place.origin_x_nm = real.origin_x_nm, place.origin_y_nm = real.origin_y_nm;
  images.used = read_masks(o.masks, place);
  const Calibration c = calibrate(images, plan.options);
  std::vector<std::string> inputs{parse_file_channel(o.image).file.string()};
  if (o.model) inputs.push_back(o.heights);
  for (const auto& input : {o.images, o.model, o.masks.use, o.masks.exclude})
    if (input) inputs.push_back(*input);
  const auto made = workflow::step_record("calibrate", record_of(o), {inputs.begin(), inputs.end()});
  if (!options.quiet) print_fit(c);
  for (const std::string& warning : c.warnings) print_warning(warning);
  if (o.residual) write_residual(*o.residual, real, images, c, plan.range_nm, made);
  if (o.output) io::write_calibration(*o.output, {c, plan.range_nm, made});
  if (o.folded) write_folded(*o.folded, *model, c, made);
  if (!options.quiet)
    for (const auto& file : {o.output, o.residual, o.folded})
      if (file) print("{:<10} {}\n", "written", *file);
  return c.outcome == CalibrationOutcome::trusted ? 0 : exit_untrustworthy;
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  const auto o = std::make_shared<CalibrateOptions>();
  CLI::App* sub = app.add_subcommand("calibrate", "Gains and offset that turn simulated images into a real one");
  add_calibrate_options(*sub, *o);
  sub->callback([o, &action] { action = [o] { return work(*o); }; });
}

}  // namespace surf::cli
