// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster_functions.h"
#include "raster_library.h"

namespace {

using namespace surf::io;

constexpr RasterLibrary table{
    openimageio::write_exr,        openimageio::write_tiff,     openimageio::write_tiled_exr,
    openimageio::write_tiled_tiff, openimageio::write_png,      openimageio::png_content,
    openimageio::format_grey_png,  openimageio::parse_grey_png, openimageio::raster_bits,
    openimageio::read_raster,      openimageio::raster_sizes};

}  // namespace

SEMSURF_MODULE(raster, table)
