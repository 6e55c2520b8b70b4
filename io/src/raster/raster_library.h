// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image_formats.h"
#include "surf/core/module.h"

namespace surf::io {

/// The function table of the module `raster`: the functions of image_formats.h that use
/// OpenImageIO.
struct RasterLibrary {
  static constexpr ModuleName module{"raster", "reads and writes EXR, TIFF and PNG files",
                                     "OpenImageIO (Debian: libopenimageio2.4)", 700,
                                     "semsurf-io-image"};

  decltype(&io::write_exr) write_exr;
  decltype(&io::write_tiff) write_tiff;
  decltype(&io::write_tiled_exr) write_tiled_exr;
  decltype(&io::write_tiled_tiff) write_tiled_tiff;
  decltype(&io::write_png) write_png;
  decltype(&io::png_content) png_content;
  decltype(&io::format_grey_png) format_grey_png;
  decltype(&io::parse_grey_png) parse_grey_png;
  decltype(&io::raster_bits) raster_bits;
  decltype(&io::read_raster) read_raster;
  decltype(&io::raster_sizes) raster_sizes;
};

}  // namespace surf::io
