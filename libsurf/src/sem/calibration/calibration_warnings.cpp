// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/calibration/calibration_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surf {
namespace {

constexpr double least_gain_in_stderrs = 2;
constexpr double strong_correlation = 0.3;  // of neighbouring residuals
constexpr double piled_up = 0.001;          // share of pixels at one extreme
constexpr std::int64_t least_pile = 10;
/// Pixels at one extreme are a pile only if the fit varies over at least this share of its range
/// there: a flat part of the surface is no pile.
constexpr double spread_in_pile = 0.05;

/// Correlation of two images over the pixels that count; relative to their means unless the offset
/// is known.
double correlation(const Grid<double>& a, const Grid<double>& b, const Grid<double>& weights,
                   bool about_means) {
  double w = 0, ma = 0, mb = 0;
  for (std::size_t i = 0; about_means && i < weights.size(); ++i) {
    if (weights.data()[i] == 0) continue;
    w += weights.data()[i], ma += weights.data()[i] * a.data()[i],
        mb += weights.data()[i] * b.data()[i];
  }
  if (w > 0) ma /= w, mb /= w;
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights.data()[i] == 0) continue;
    const double x = a.data()[i] - ma, y = b.data()[i] - mb;
    aa += weights.data()[i] * x * x, bb += weights.data()[i] * y * y,
        ab += weights.data()[i] * x * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// The two channels with the largest correlation, and the correlation.
std::string most_alike(const CalibrationImages& images, const Grid<double>& weights,
                       bool about_means) {
  double most = 0;
  std::string text;
  for (std::size_t i = 0; i < images.channels.size(); ++i) {
    for (std::size_t j = i + 1; j < images.channels.size(); ++j) {
      const double r = correlation(images.simulated[i], images.simulated[j], weights, about_means);
      if (std::fabs(r) < most) continue;
      most = std::fabs(r);
      text = fmt::format("{} and {} have a correlation of {:.6f}", images.channels[i],
                         images.channels[j], r);
    }
  }
  return text;
}

void judge_channels(Calibration& c, const CalibrationImages& images,
                    const CalibrationOptions& options, const Grid<double>& weights) {
  constexpr const char* remedy = "fix the ratio of the gains or use one channel";
  const bool several = c.channels.size() > 1 && options.ratios.empty();
  if (c.outcome == CalibrationOutcome::undetermined) {
    c.warnings.push_back(
        several ? fmt::format("the gains cannot be told apart: {}, or one does not vary; {}",
                              most_alike(images, weights, !options.offset), remedy)
                : "the simulated image does not vary, so that its gain cannot be told from the "
                  "offset; use a part with relief, or give the offset");
  } else if (c.condition_number > options.highest_condition) {
    c.outcome = CalibrationOutcome::doubtful;
    c.warnings.push_back(fmt::format("the channels are too alike to tell their gains apart: {}; {}",
                                     most_alike(images, weights, !options.offset), remedy));
  }
}

void judge_gains(Calibration& c) {
  if (c.outcome == CalibrationOutcome::undetermined) return;
  std::size_t vague = 0;
  for (std::size_t i = 0; i < c.gains.size(); ++i) {
    const double gain = c.gains[i], error = c.gain_stderr(i);
    if (gain < -least_gain_in_stderrs * error) {
      c.outcome = CalibrationOutcome::doubtful;
      c.warnings.push_back(
          fmt::format("the gain of {} is below 0, which no detector has: the image may be inverted "
                      "or not registered, or the other channel has taken over",
                      c.channels[i]));
    } else if (gain < least_gain_in_stderrs * error || gain == 0) {
      vague += 1;  // a detector that does not detect a channel is not an error
      c.warnings.push_back(
          fmt::format("the gain of {} is {:.3g} with a standard error of {:.2g}: it may be 0",
                      c.channels[i], gain, error));
    }
  }
  if (vague == c.gains.size()) c.outcome = CalibrationOutcome::doubtful;
}

/// Warns of pixels at the lowest or the highest level where the fit is not constant: they are
/// probably clipped.
void judge_level(Calibration& c, const Grid<double>& real, const Grid<double>& fit,
                 const Grid<double>& weights, bool white) {
  double level = 0, fit_low = 0, fit_high = 0, pile_low = 0, pile_high = 0;
  bool first = true;
  std::int64_t pile = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights.data()[i] == 0) continue;
    const double e = real.data()[i], f = fit.data()[i];
    if (first || (white ? e > level : e < level)) level = e, pile = 0, pile_low = pile_high = f;
    if (first) fit_low = fit_high = f;
    first = false;
    fit_low = std::min(fit_low, f), fit_high = std::max(fit_high, f);
    if (e != level) continue;
    ++pile;
    pile_low = std::min(pile_low, f), pile_high = std::max(pile_high, f);
  }
  const auto least =
      std::max(least_pile, static_cast<std::int64_t>(piled_up * static_cast<double>(c.pixels)));
  if (pile < least || !(pile_high - pile_low > spread_in_pile * (fit_high - fit_low))) return;
  c.warnings.push_back(
      fmt::format("{} pixels have exactly the {} level, {:.6g}: they look saturated and bias the "
                  "gains; leave them out by --{} {:.6g}",
                  pile, white ? "highest" : "lowest", level, white ? "white" : "black", level));
}

}  // namespace

void judge(Calibration& c, const CalibrationImages& images, const CalibrationOptions& options,
           const Grid<double>& weights) {
  judge_channels(c, images, options, weights);
  judge_gains(c);
  const Grid<double> fit = calibrated_image(c, images.simulated);
  judge_level(c, images.real, fit, weights, false);
  judge_level(c, images.real, fit, weights, true);
  // Rounding errors have structure, too.
  if (c.residual_correlation > strong_correlation && 1 - c.explained > 1e-10)
    c.warnings.push_back(fmt::format(
        "residuals of neighbouring pixels have a correlation of {:.2f}: the model is off "
        "in places, and the standard errors, which take pixels as independent, are too "
        "small",
        c.residual_correlation));
}

}  // namespace surf
