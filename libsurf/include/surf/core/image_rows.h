// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "surf/core/image.h"

namespace surf {

/// An image whose values are made row by row when they are asked for, so that it may be larger than
/// the memory.
struct ImageRows {
  Image head;      ///< names and units of the channels without values, placement and metadata
  int width = 0;   ///< at least 1
  int height = 0;  ///< at least 1
  /// Sets `row`, of `width` values, to row `y` of a channel; row 0 is the lowest. Asked in any
  /// order, more than once, by one thread at a time.
  std::function<void(std::size_t channel, int y, std::span<float> row)> read;
};

/// The rows of an image, which must outlive them.
ImageRows rows_of(const Image& image);

/// All rows.
Image to_image(const ImageRows& rows);

}  // namespace surf
