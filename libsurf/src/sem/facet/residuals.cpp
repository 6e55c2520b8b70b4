// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/sem/fit_filter_bank.h"

namespace surf {
namespace {

struct Sums {
  double square = 0, noise = 0, relative = 0, signal = 0;
  std::int64_t pixels = 0, positive = 0;
};

void add(const TrainingImage& image, std::size_t channel, const Grid<double>& predicted,
         Sums& sums) {
  const std::vector<float>& measured = image.images[channel].data();
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!image.used.empty() && image.used.data()[i] == 0) continue;
    const double difference = predicted.data()[i] - measured[i];
    sums.square += difference * difference;
    if (!image.standard_errors.empty()) {
      const double error = image.standard_errors[channel].data()[i];
      sums.noise += error * error;
    }
    sums.signal += measured[i];
    ++sums.pixels;
    if (measured[i] > 0) {
      sums.relative += std::abs(difference) / measured[i];
      ++sums.positive;
    }
  }
}

}  // namespace

std::vector<ModelResidual> residuals_of(const ImageModel& model,
                                        const std::vector<TrainingImage>& images, int threads) {
  validate(images);
  const std::size_t channels = model.channels().size();
  if (images.front().images.size() != channels)
    throw InvalidInput(
        images.front().name,
        fmt::format("it has {} channels, the model has {}", images.front().images.size(), channels),
        "Give images of the model's channels");
  std::vector<Sums> sums(channels);
  for (const TrainingImage& image : images) {
    const ModelImages predicted =
        model.predict(image.field, {.edge = image.edge, .threads = threads});
    for (std::size_t c = 0; c < channels; ++c) add(image, c, predicted[c], sums[c]);
  }
  std::vector<ModelResidual> residuals;
  for (std::size_t c = 0; c < channels; ++c) {
    const Sums& s = sums[c];
    ModelResidual& r = residuals.emplace_back();
    r.channel = model.channels()[c];
    r.pixels = s.pixels;
    if (s.pixels == 0) continue;
    const double count = static_cast<double>(s.pixels);
    r.rms = std::sqrt(std::max(0.0, (s.square - s.noise) / count));
    r.noise_rms = std::sqrt(s.noise / count);
    r.mean_signal = s.signal / count;
    if (s.positive > 0) r.mean_relative = s.relative / static_cast<double>(s.positive);
  }
  return residuals;
}

}  // namespace surf
