// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "surf/core/grid.h"
#include "surf/core/image_rows.h"

namespace surf::io {

/// Writes one channel as a PNG, stretched between its 0.5 and 99.5 percentiles, or its extremes if
/// these coincide. Pixels that are not finite or not valid do not count and are black. Reads the
/// channel three times and keeps one row at a time.
void write_grey_picture(const std::filesystem::path& target, const std::string& file,
                        const ImageRows& rows, std::size_t channel);

/// A grey picture in memory, made as `write_grey_picture` makes it.
struct GreyPicture {
  Grid<std::uint8_t> grey;  ///< row 0 is the lowest
  float low = 0;            ///< value shown as 0
  /// Value shown as 255; equal to `low` if all values are equal, which are then shown as 128.
  float high = 0;
};
GreyPicture make_grey_picture(const ImageRows& rows, std::size_t channel);

}  // namespace surf::io
