// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/calibrate_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "surf/core/error.h"
#include "surf/core/words.h"

namespace surf::workflow {
namespace {

constexpr double same_pitch = 1e-3;  // relative; models demand the same of fields
constexpr double most_level = 1e9;   // beyond this, grey levels could no longer be distinguished

/// Names in one text with commas, not a list of values: the text is given once.
class NamesField final : public Field {
 public:
  explicit NamesField(std::vector<std::string>& names) : names_(names) {}
  FieldKind kind() const override { return FieldKind::text; }
  bool given() const override { return !names_.empty(); }
  std::string text() const override { return fmt::format("{}", fmt::join(names_, ",")); }
  void read(std::string_view text, const std::string&) override {
    names_.clear();
    for (const std::string_view name : split(text, ",")) {
      const std::size_t first = name.find_first_not_of(' ');
      names_.emplace_back(
          first == name.npos ? "" : name.substr(first, name.find_last_not_of(' ') + 1 - first));
    }
  }
  void clear() override { names_.clear(); }

 private:
  std::vector<std::string>& names_;
};

void check_same_pixels(const CalibrateInput& input) {
  const PlacedImage& real = input.image;
  const Image& simulated = input.simulated;
  constexpr const char* remedy =
      "They have to show the same surface pixel on pixel: register and resample one first";
  if (real.values.width() != simulated.width() || real.values.height() != simulated.height())
    throw InvalidInput(input.name,
                       fmt::format("it has {} x {} pixels, {} has {} x {}", real.values.width(),
                                   real.values.height(), input.simulated_name, simulated.width(),
                                   simulated.height()),
                       remedy);
  const auto differ = [](double a, double b) { return std::fabs(a - b) > same_pitch * b; };
  if (differ(real.pitch_x_nm, simulated.pitch_x_nm) ||
      differ(real.pitch_y_nm, simulated.pitch_y_nm))
    throw InvalidInput(
        input.name,
        fmt::format("its pixels are {:.6g} x {:.6g} nm, those of {} {:.6g} x {:.6g} nm",
                    real.pitch_x_nm, real.pitch_y_nm, input.simulated_name, simulated.pitch_x_nm,
                    simulated.pitch_y_nm),
        remedy);
}

Grid<double> values(const Image& image, const Channel& channel) {
  const Channel* valid = image.find("valid");
  Grid<double> out(image.width(), image.height());
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] = valid && valid->values.data()[i] == 0 ? NAN : double{channel.values.data()[i]};
  return out;
}

CalibrationImages images_of(const CalibrateInput& input, const CalibrateParameters& p) {
  CalibrationImages images;
  images.real = input.image.values;
  images.used = input.image.valid;
  std::vector<std::string> wanted = p.fit;
  if (wanted.empty())
    for (const char* usual : {"SE", "BSE"})
      if (input.simulated.find(usual)) wanted.emplace_back(usual);
  if (wanted.empty())
    throw UsageError(input.simulated_name, "it has no channel SE or BSE",
                     "Say which of its channels to fit with `calibration.fit`");
  if (p.ratio && wanted.size() != 2)
    throw UsageError("`calibration.ratio`",
                     fmt::format("it is of two channels, not of {}", wanted.size()),
                     "Fit two channels, or leave it out");
  for (const std::string& name : wanted) {
    const Channel* channel = input.simulated.find(name);
    if (!channel) {
      std::vector<std::string> names;
      for (const Channel& c : input.simulated.channels) names.push_back(c.name);
      throw UsageError("`calibration.fit`",
                       fmt::format("{} has no channel '{}'", input.simulated_name, name),
                       fmt::format("Choose of: {}", fmt::join(names, ", ")));
    }
    images.channels.push_back(name);
    images.simulated.push_back(values(input.simulated, *channel));
  }
  return images;
}

CalibrationOptions options_of(const CalibrateParameters& p) {
  CalibrationOptions options;
  if (p.ratio) options.ratios = {1, *p.ratio};
  options.offset = p.offset;
  options.black = p.black.value_or(options.black);
  options.white = p.white.value_or(options.white);
  return options;
}

/// Multiplies the fit by a slowly varying gain. The fit is unknown where the gain is unknown.
void vary_gain(const CalibrateInput& input, const CalibrationImages& images, double range_nm,
               CalibrateResult& result, const Reporter& reporter) {
  const auto pixels = [&](double pitch_nm) {
    return static_cast<int>(std::min(range_nm / pitch_nm, 1e9));
  };
  SlowGain slow = slow_gain(images.real, result.fit, pixels(input.image.pitch_x_nm),
                            pixels(input.image.pitch_y_nm), images.used);
  if (slow.unknown)
    reporter.warn(
        fmt::format("{} pixels have nothing around them to take a gain from: they are not valid in "
                    "the residual",
                    slow.unknown));
  for (std::size_t i = 0; i < slow.gain.size(); ++i) {
    result.fit.data()[i] *= slow.gain.data()[i];
    if (!slow.known.data()[i]) result.fit.data()[i] = std::numeric_limits<double>::quiet_NaN();
  }
  result.gain = std::move(slow.gain);
}

}  // namespace

void describe(ParameterVisitor& visit, CalibrateParameters& p) {
  visit(p.edge, {"mirror", "flat", "periodic"},
        {.name = "calibration.edge", .help = "Continuation of HEIGHTS outside their samples"});
  NamesField fit(p.fit);
  visit.visit({.name = "calibration.fit",
               .help = "Simulated channels to fit",
               .otherwise = "SE,BSE, those that are there",
               .form = "NAMES"},
              fit);
  visit(p.ratio, {.name = "calibration.ratio",
                  .help = "Ratio of the second channel's gain to the first's, where it is known",
                  .otherwise = "fitted"});
  visit(p.offset, {.name = "calibration.offset",
                   .help = "Grey level without a signal, where it is known",
                   .limits = within(-most_level, most_level),
                   .otherwise = "fitted"});
  visit(p.black, {.name = "calibration.black",
                  .help = "Grey level at and below which pixels are saturated and left out",
                  .limits = within(-most_level, most_level),
                  .otherwise = "none are"});
  visit(p.white, {.name = "calibration.white",
                  .help = "Grey level at and above which pixels are saturated and left out",
                  .limits = within(-most_level, most_level),
                  .otherwise = "none are"});
  visit(p.range_nm, {.name = "calibration.range",
                     .help = "Half the width of the squares over which the gain may vary",
                     .unit = Unit::nm,
                     .limits = above(0),
                     .otherwise = "it is constant"});
}

void check(const CalibrateParameters& p) {
  check_parameters(p);
  for (const std::string& name : p.fit)
    if (name.empty() || std::ranges::count(p.fit, name) > 1)
      throw UsageError("`calibration.fit`", "a channel is named twice, or not at all",
                       "Give names, as SE,BSE");
  const CalibrationOptions options = options_of(p);
  if (!(options.black < options.white))
    throw UsageError("`calibration.white`", "it is not above `calibration.black`",
                     "Exchange the two levels");
}

CalibrateResult calibrate(const CalibrateInput& input, const CalibrateParameters& p,
                          const Reporter& reporter) {
  check(p);
  check_same_pixels(input);
  const CalibrationImages images = images_of(input, p);
  CalibrateResult result;
  result.calibration = surf::calibrate(images, options_of(p));
  for (const std::string& warning : result.calibration.warnings) reporter.warn(warning);
  result.fit = calibrated_image(result.calibration, images.simulated);
  if (p.range_nm) vary_gain(input, images, *p.range_nm, result, reporter);
  result.residual = result.fit;
  for (std::size_t i = 0; i < result.residual.size(); ++i)
    result.residual.data()[i] = images.real.data()[i] - result.fit.data()[i];
  return result;
}

}  // namespace surf::workflow
