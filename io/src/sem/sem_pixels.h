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
  Mask valid;           ///< empty: all pixels are valid
  std::string channel;  ///< set for files with several channels
  int bits = 0;         ///< 0: floats
  std::vector<std::string> notes;
};

/// Reads an uncompressed TIFF page with a palette: the indices into the palette. The palette may be
/// non-linear, and its coloured entries are annotations. Empty if the page is of another kind.
SemPixels palette_pixels(const TiffPage& page, const Bytes& file);

/// Takes the pixels of an image that the image library has read. `channel` as in SemReadOptions.
SemPixels grey_pixels(const Image& image, const std::string& channel, const std::string& file);

}  // namespace surf::io
