// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/core/edge.h"
#include "surf/core/grid.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

/// A surface and images of it, pixel on sample, to learn a model from.
struct TrainingImage {
  std::string name;          ///< for messages
  HeightField field;         ///< without masked samples
  Edge edge = Edge::mirror;  ///< how it went on when the images were made
  /// One per channel that is learnt, of the field's size, finite where used.
  std::vector<Grid<float>> images;
  std::vector<Grid<float>>
      standard_errors;  ///< of the same sizes, > 0 where used; or none: all weigh alike
  Mask used;            ///< 0: the pixel is left out; or empty: all are used
};

/// Throws InvalidInput, naming the image, for sizes that differ, values that are not finite, or if
/// there are none or not the same number of channels in all.
void validate(const std::vector<TrainingImage>& images);

}  // namespace surf
