// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/all_within.h"
#include "surf/core/error.h"

namespace surf {

void validate_raster(const Placement& placement, const Grid<double>& values, const Mask& valid,
                     const RasterWords& words, const char* subject) {
  const int width = values.width(), height = values.height();
  if (width < 2 || height < 2) {
    throw InvalidInput(subject, fmt::format("it has {} x {} samples", width, height),
                       fmt::format("{} needs at least 2 x 2", words.raster));
  }
  validate(placement, subject);
  if (!valid.empty() && (valid.width() != width || valid.height() != height)) {
    throw InvalidInput(subject,
                       fmt::format("its mask has {} x {} samples, its {}s {} x {}", valid.width(),
                                   valid.height(), words.value, width, height),
                       "Give a mask of the same size, or none");
  }
  if (all_within(values.data(), largest_raster_number)) return;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double value = values(column, row);
      if (!valid.includes(column, row) || std::abs(value) <= largest_raster_number) continue;
      throw InvalidInput(
          subject,
          fmt::format("the {} at column {}, row {} is {}", words.value, column, row, value),
          std::isfinite(value) ? "Nothing computes with more than 1e60: check the unit"
                               : "Fill the sample or mark it as invalid");
    }
  }
}

}  // namespace surf
