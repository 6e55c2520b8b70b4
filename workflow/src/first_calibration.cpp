// SPDX-License-Identifier: GPL-3.0-or-later
#include "first_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "sem_frame.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/sem/estimate_sem_noise.h"
#include "surf/sem/noise_of_residuals.h"

namespace surf::workflow {
namespace {

constexpr double telling_share = 1e-3;  // share of the pixels at one value
constexpr double telling_step = 3;      // ratio to the pixels at the next value
constexpr double least_overlap_px = 256;
constexpr double changed = 0.1;  // relative change of a gain or of the noise's variance

struct Extreme {
  double value = 0;
  std::int64_t count = 0, next = 0;  // pixels at this value, and at the adjacent value
};

Extreme extreme(const PlacedImage& image, bool largest) {
  std::vector<double> values;
  for (int y = 0; y < image.values.height(); ++y)
    for (int x = 0; x < image.values.width(); ++x)
      if (image.is_valid(x, y))
        values.push_back(largest ? -image.values(x, y) : image.values(x, y));
  Extreme e;
  if (values.empty()) return e;
  std::ranges::sort(values);
  const auto second = std::ranges::upper_bound(values, values.front());
  e.count = second - values.begin();
  if (second != values.end())
    e.next = std::ranges::upper_bound(second, values.end(), *second) - second;
  e.value = largest ? -values.front() : values.front();
  return e;
}

/// The mean image: predicted channels times gains, plus offset.
Grid<double> mean_of(const ModelImages& predicted, const std::vector<double>& gains,
                     double offset) {
  Grid<double> mean(predicted.front().width(), predicted.front().height(), offset);
  for (std::size_t c = 0; c < predicted.size(); ++c)
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean.data()[i] += gains[c] * predicted[c].data()[i];
  return mean;
}

double variance_of(const Grid<double>& values, const Mask& used) {
  double sum = 0, squared = 0, count = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (used.data()[i])
      sum += values.data()[i], squared += values.data()[i] * values.data()[i], ++count;
  return count > 1 ? std::max(squared / count - sum / count * (sum / count), 0.0) : 0;
}

/// The grey levels below which these shares of the image lie.
std::vector<double> levels_of(const Grid<double>& image, std::initializer_list<double> shares) {
  std::vector<double> values = image.data(), levels;
  for (const double share : shares) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    levels.push_back(*at);
  }
  return levels;
}

/// Estimates the noise from flat places, if there are any.
void find_noise(const PlacedImage& sem, const std::optional<SemNoise>& given,
                FirstCalibration& first) {
  if (given) {
    validate(*given, "`reconstruction.sem_noise`");
    first.noise = *given;
    first.noise_from = "given";
    return;
  }
  try {
    const SemNoiseEstimate estimate = estimate_sem_noise(sem);
    first.noise = estimate.noise;
    first.noise_from = fmt::format("{} flat places of the image",
                                   std::ranges::count_if(estimate.points, &NoisePoint::used));
    first.warnings = estimate.warnings;
  } catch (const InvalidInput&) {  // no flat places: the noise is estimated from residuals later
  }
}

Grid<double> weights_of(const Grid<double>& mean, const SemNoise& noise) {
  Grid<double> weights = mean;
  for (double& w : weights.data()) w = 1 / noise.variance(w);
  return weights;
}

Calibration fitted(const CalibrationImages& images, FirstCalibration& first) {
  Calibration fit = calibrate(images);
  first.tied = fit.channels.size() > 1 && fit.outcome != CalibrationOutcome::trusted;
  if (first.tied) {
    CalibrationOptions one;
    one.ratios.assign(fit.channels.size(), 1);
    fit = calibrate(images, one);
  }
  if (std::ranges::all_of(fit.gains, [](double g) { return !(g > 0); }))
    throw InvalidInput(
        "SEM image",
        "it is darker where the simulated image is brighter, so the two do not show the same",
        "Check the registration (semsurf register --picture), the material and the energy, or give "
        "`reconstruction.gains`");
  return fit;
}

/// The noise in the residual of a coarse reconstruction. The residual also holds the errors of
/// model and surface, mostly on walls. A line fitted to squared residuals follows a few bright
/// walls, or becomes so uncertain because of them that it is level. So the line is fitted to
/// differences between neighbours.
SemNoise noise_left(const CalibrationImages& images, const Grid<double>& mean) {
  try {
    return noise_of_residuals(images.real, mean, images.used);
    // The image is too small, or the noise is finer than the grey levels.
  } catch (const InvalidInput&) {
    return fit_sem_noise(images.real, mean, images.used).noise;
  }
}

}  // namespace

std::int64_t leave_out_saturated(PlacedImage& image) {
  std::int64_t left_out = 0;
  const auto share = telling_share * static_cast<double>(image.values.size());
  for (const bool largest : {false, true}) {
    const Extreme e = extreme(image, largest);
    if (e.next == 0 || static_cast<double>(e.count) <= share ||
        static_cast<double>(e.count) <= telling_step * double(e.next))
      continue;
    if (image.valid.empty()) image.valid = Mask(image.values.width(), image.values.height(), 1);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      if (image.valid.data()[i] && image.values.data()[i] == e.value) {
        image.valid.data()[i] = 0;
        ++left_out;
      }
  }
  return left_out;
}

FirstCalibration calibrate_first(const PlacedImage& sem, const HeightField* eroded,
                                 const ImageModel& model, const Affine& sem_to_afm,
                                 const std::optional<GivenCalibration>& given,
                                 const std::optional<SemNoise>& noise, int threads) {
  FirstCalibration first;
  const std::size_t channels = model.channels().size();
  if (given && given->gains.size() != channels)
    throw UsageError(
        "`reconstruction.gains`",
        fmt::format("{} are given, and the model has {} channels", given->gains.size(), channels),
        "Give one for each of the model's channels, 0 for those that the image has nothing of");
  CalibrationImages images;
  images.real = sem.values;
  images.used = sem.valid.empty() ? Mask(sem.values.width(), sem.values.height(), 1) : sem.valid;
  if (!(variance_of(images.real, images.used) > 0))
    throw InvalidInput("SEM image", "all its pixels that count have one value",
                       "Give an image that shows something, and is not saturated");
  find_noise(sem, noise, first);
  if (given) {
    first.gains = given->gains;
    first.offset = given->offset;
  }
  if (!eroded && first.noise_from.empty())
    throw UsageError(
        "`reconstruction.sem_noise`",
        "it is missing, and the SEM image has no flat places to take it from",
        "Say what 'semsurf noise' finds on another image, as `reconstruction.sem_noise=1.2,30`");
  if (eroded) {
    const SurfaceUnderSem under = surface_under_sem(*eroded, sem, sem_to_afm);
    first.overlap = under.overlap;
    if (under.overlap * static_cast<double>(sem.values.size()) < least_overlap_px)
      throw InvalidInput(
          "SEM image", fmt::format("only {:.2g} % of it lies on the AFM scan", 100 * under.overlap),
          "Check the transform, landmarks and pixel sizes: the images have to overlap");
    ModelOptions options;
    options.threads = threads;
    const ModelImages predicted = model.predict(under.surface, options);
    for (std::size_t i = 0; i < images.used.size(); ++i)
      images.used.data()[i] &= under.known.data()[i];
    if (!given) {
      images.channels = model.channels();
      images.simulated = predicted;
      first.fit = fitted(images, first);
      if (!first.noise_from.empty()) {
        images.weights =
            weights_of(mean_of(predicted, first.fit->gains, first.fit->offset), first.noise);
        first.fit = fitted(images, first);
      }
      first.gains = first.fit->gains;
      first.offset = first.fit->offset;
    }
    if (first.noise_from.empty()) {
      const SemNoiseEstimate estimate =
          fit_sem_noise(images.real, mean_of(predicted, first.gains, first.offset), images.used);
      first.noise = estimate.noise;
      first.noise_from = "the residuals of the first calibration";
      first.warnings.push_back(
          "the SEM image has no flat places, so its noise is taken from what the eroded scan does "
          "not "
          "explain, which is too large. Say `reconstruction.sem_noise` if you know it");
    }
  }
  return first;
}

bool calibrate_again(const PlacedImage& sem, const HeightField& surface, const ImageModel& model,
                     bool fix_gains, bool fix_noise, int threads, FirstCalibration& first) {
  ModelOptions options;
  options.threads = threads;
  const FirstCalibration before = first;
  CalibrationImages images;
  images.real = sem.values;
  images.used = sem.valid;
  images.channels = model.channels();
  images.simulated = model.predict(surface, options);
  Grid<double> mean = mean_of(images.simulated, first.gains, first.offset);
  if (!fix_gains) {
    images.weights = weights_of(mean, first.noise);
    first.fit = fitted(images, first);
    first.gains = first.fit->gains;
    first.offset = first.fit->offset;
    mean = mean_of(images.simulated, first.gains, first.offset);
  }
  if (!fix_noise) {
    first.noise = noise_left(images, mean);
    first.noise_from = "what a first reconstruction leaves of the image";
    first.warnings.clear();  // these are about the earlier noise estimate
  }
  const auto differs = [](double a, double b) {
    return std::abs(a - b) > changed * std::max(std::abs(a), std::abs(b));
  };
  bool differ = first.tied != before.tied;
  for (std::size_t c = 0; c < first.gains.size(); ++c)
    differ = differ || differs(first.gains[c], before.gains[c]);
  for (const double level : levels_of(mean, {0.1, 0.5, 0.9}))
    differ = differ || differs(first.noise.variance(level), before.noise.variance(level));
  return differ;
}

}  // namespace surf::workflow
