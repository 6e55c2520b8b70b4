// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/image_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "surf/core/error.h"

namespace surf {
namespace {

void check(std::span<const double> values, std::size_t pixels, bool may_be_none) {
  if (may_be_none && values.empty()) return;
  if (values.size() != pixels || pixels == 0)
    throw InvalidInput("images", "they do not have the same pixels",
                       "Compare images of one size, of one pixel at least");
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
    throw InvalidInput("images", "a pixel is not a finite number", "Leave such pixels out");
}

}  // namespace

ImageError image_error(std::span<const double> values, std::span<const double> standard_errors,
                       std::span<const double> reference,
                       std::span<const double> reference_errors) {
  check(reference, values.size(), false);
  check(values, reference.size(), false);
  check(standard_errors, values.size(), true);
  check(reference_errors, values.size(), true);
  ImageError e;
  e.pixels = static_cast<std::int64_t>(values.size());
  const auto n = static_cast<double>(values.size());
  for (const double r : reference) e.mean_signal += r / n;
  if (!(e.mean_signal > 0))
    throw InvalidInput("reference image", "it shows no signal",
                       "Compare with an image whose mean is above 0");
  std::vector<double> relative(values.size());
  double squares = 0, noise = 0, reference_noise = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double scale = std::max(reference[i], darkest_share * e.mean_signal);
    const double off = values[i] - reference[i];
    relative[i] = std::abs(off) / scale;
    e.mean += relative[i] / n;
    e.bias += off / n;
    squares += relative[i] * relative[i];
    if (!standard_errors.empty()) noise += std::pow(standard_errors[i] / scale, 2);
    if (!reference_errors.empty()) reference_noise += std::pow(reference_errors[i] / scale, 2);
  }
  e.bias /= e.mean_signal;
  e.rms = std::sqrt(squares / n);
  e.noise = std::sqrt(noise / n);
  e.reference_noise = std::sqrt(reference_noise / n);
  e.beyond_noise = std::sqrt(std::max(0.0, squares - noise - reference_noise) / n);
  std::sort(relative.begin(), relative.end());
  e.largest = relative.back();
  e.percentile95 =
      relative[std::min(relative.size() - 1, static_cast<std::size_t>(std::ceil(0.95 * n)) - 1)];
  return e;
}

}  // namespace surf
