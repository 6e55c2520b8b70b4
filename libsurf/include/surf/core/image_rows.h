// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "surf/core/image.h"

namespace surf {

/// An image whose rows are computed on request, so that it may be larger than the memory.
struct ImageRows {
  Image head;      ///< placement, metadata, and channels with names and units but without values
  int width = 0;   ///< at least 1
  int height = 0;  ///< at least 1
  /// Fills `row` (`width` values) with row `y` of a channel; row 0 is the lowest. Rows may be
  /// requested in any order and repeatedly, by one thread at a time.
  std::function<void(std::size_t channel, int y, std::span<float> row)> read;
};

/// The rows of `image`, which must outlive the result.
ImageRows rows_of(const Image& image);

/// The image that consists of all rows.
Image to_image(const ImageRows& rows);

}  // namespace surf
