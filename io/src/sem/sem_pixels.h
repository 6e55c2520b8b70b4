// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../afm/tiff_tags.h"
#include "surf/core/grid.h"
#include "surf/core/image.h"
#include "surf/core/mask.h"

namespace surf::io {

/// The picture of an SEM file, before anything is cut off.
struct SemPixels {
  Grid<double> values;
  Mask valid;           ///< empty: all are
  std::string channel;  ///< of files with several
  int bits = 0;         ///< 0: floats
  std::vector<std::string> notes;
};

/// Of a TIFF page with a palette that is stored as it is: the numbers before the palette, which may
/// be bent, and whose entries in colour are for annotations. Empty where the page is of another
/// kind.
SemPixels palette_pixels(const TiffPage& page, const Bytes& file);

/// Of an image as its library reads it. `channel` as in SemReadOptions.
SemPixels grey_pixels(const Image& image, const std::string& channel, const std::string& file);

}  // namespace surf::io
