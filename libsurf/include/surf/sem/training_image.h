// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/edge.h"
#include "surf/core/grid.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

/// A surface and its images, pixel on sample, for the training of a model.
struct TrainingImage {
  std::string name;          ///< for messages
  HeightField field;         ///< without masked samples
  Edge edge = Edge::mirror;  ///< how the field was continued for the images
  /// One image per trained channel, of the field's size, finite where used.
  std::vector<Grid<float>> images;
  /// Of the same sizes, > 0 where used; or none: all pixels have the same weight.
  std::vector<Grid<float>> standard_errors;
  Mask used;  ///< 0: the pixel is left out; empty: all are used
};

/// Throws InvalidInput, naming the image, for sizes that differ, values that are not finite, no
/// images, and different numbers of channels.
void validate(const std::vector<TrainingImage>& images);

}  // namespace surf
