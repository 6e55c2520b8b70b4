// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/model_residual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"

namespace surf {

ResidualSum::ResidualSum(std::vector<std::string> channels)
    : channels_(std::move(channels)), sums_(channels_.size()) {}

void ResidualSum::add(const ModelImages& predicted, const TrainingImage& image) {
  if (predicted.size() != sums_.size() || image.images.size() != sums_.size())
    throw InvalidInput(image.name, fmt::format("it has {} channels, the model {}", image.images.size(), sums_.size()),
                       "Judge a model by images of its own channels");
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    const auto& p = predicted[c].data();
    const auto& i = image.images[c].data();
    if (p.size() != i.size())
      throw InvalidInput(image.name, "image and surface differ in size", "Give images pixel on sample");
    Sums& sums = sums_[c];
    for (std::size_t k = 0; k < i.size(); ++k) {
      if (!image.used.empty() && !image.used.data()[k]) continue;
      const double seen = i[k], off = p[k] - seen;
      const double noise = image.standard_errors.empty() ? 0 : image.standard_errors[c].data()[k];
      if (!std::isfinite(off) || !std::isfinite(noise)) continue;
      sums.square += off * off;
      sums.noise += noise * noise;
      sums.signal += seen;
      ++sums.pixels;
      if (!(seen > 0)) continue;
      sums.relative += std::abs(off) / seen;
      ++sums.relative_pixels;
    }
  }
}

std::vector<ModelResidual> ResidualSum::residuals() const {
  std::vector<ModelResidual> residuals;
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    const Sums& sums = sums_[c];
    const double n = static_cast<double>(std::max<std::int64_t>(sums.pixels, 1));
    ModelResidual r;
    r.channel = channels_[c];
    r.rms = std::sqrt(std::max(0.0, (sums.square - sums.noise) / n));
    r.noise_rms = std::sqrt(sums.noise / n);
    r.mean_relative = sums.relative / static_cast<double>(std::max<std::int64_t>(sums.relative_pixels, 1));
    r.mean_signal = sums.signal / n;
    r.pixels = sums.pixels;
    residuals.push_back(r);
  }
  return residuals;
}

std::vector<ModelResidual> judge(const ImageModel& model, const TrainingImage& image, int threads) {
  ResidualSum sum(model.channels());
  sum.add(model.predict(image.field, {image.edge, threads}), image);
  return sum.residuals();
}

}  // namespace surf
