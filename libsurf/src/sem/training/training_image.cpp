// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/training_image.h"

#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/sem/image_model.h"

namespace surf {
namespace {

template <class T>
void check_size(const TrainingImage& image, const Grid<T>& grid, const char* what) {
  const Grid<double>& z = image.field.z_nm;
  if (grid.width() == z.width() && grid.height() == z.height()) return;
  throw InvalidInput(image.name,
                     fmt::format("{} has {} x {} pixels, the heights have {} x {} samples", what,
                                 grid.width(), grid.height(), z.width(), z.height()),
                     "An image lies pixel on sample: resample one of them");
}

void check_channel(const TrainingImage& image, std::size_t channel) {
  const Grid<float>& values = image.images[channel];
  const Grid<float>* const errors =
      image.standard_errors.empty() ? nullptr : &image.standard_errors[channel];
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!image.used.empty() && image.used.data()[i] == 0) continue;
    const int x = static_cast<int>(i % values.width()), y = static_cast<int>(i / values.width());
    if (!std::isfinite(values.data()[i]))
      throw InvalidInput(
          image.name,
          fmt::format("channel {} is {} at column {}, row {}", channel + 1, values.data()[i], x, y),
          "Mark the pixel as unused or mend the image");
    if (errors && !(std::isfinite(errors->data()[i]) && errors->data()[i] > 0))
      throw InvalidInput(
          image.name,
          fmt::format("the standard error of channel {} is {} at column {}, row {}", channel + 1,
                      errors->data()[i], x, y),
          "It has to be above 0: mark the pixel as unused or give no standard errors");
  }
}

}  // namespace

void validate(const std::vector<TrainingImage>& images) {
  if (images.empty()) throw InvalidInput("training", "there are no images", "Give at least one");
  const std::size_t channels = images.front().images.size();
  for (const TrainingImage& image : images) {
    check_field({}, image.field, image.name.c_str());
    if (image.images.empty())
      throw InvalidInput(image.name, "it has no channels", "Give at least one");
    if (image.images.size() != channels)
      throw InvalidInput(image.name,
                         fmt::format("it has {} channels, {} has {}", image.images.size(),
                                     images.front().name, channels),
                         "Give images of the same channels");
    if (!image.standard_errors.empty() && image.standard_errors.size() != channels)
      throw InvalidInput(image.name,
                         fmt::format("it has {} channels and {} standard errors", channels,
                                     image.standard_errors.size()),
                         "Give one for each channel, or none");
    for (const Grid<float>& grid : image.images) check_size(image, grid, "a channel");
    for (const Grid<float>& grid : image.standard_errors)
      check_size(image, grid, "a standard error");
    if (!image.used.empty()) check_size(image, image.used, "the mask");
    for (std::size_t c = 0; c < channels; ++c) check_channel(image, c);
  }
}

}  // namespace surf
