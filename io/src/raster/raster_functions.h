// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the module `raster`, documented in image_formats.h.
#pragma once

#include "image_formats.h"

namespace surf::io::openimageio {

void write_exr(const std::filesystem::path& target, const std::string& file, const ImageRows& rows);
void write_tiff(const std::filesystem::path& target, const std::string& file,
                const ImageRows& rows);
void write_tiled_exr(const std::filesystem::path& target, const std::string& file,
                     const ImageRows& rows, std::span<const std::string> labels);
void write_tiled_tiff(const std::filesystem::path& target, const std::string& file,
                      const ImageRows& rows, std::span<const std::string> labels);
void write_png(const std::filesystem::path& target, const std::string& file, const Image& head,
               int width, int height, const GreyRow& grey);
std::string png_content(const std::string& file, const Image& head, int width, int height,
                        const GreyRow& grey);
std::string format_grey_png(const std::string& file, const Grid<std::uint8_t>& grey);
Grid<std::uint8_t> parse_grey_png(const std::string& file, std::string_view content);
int raster_bits(const std::filesystem::path& path);
Image read_raster(const std::filesystem::path& path, int level);
std::vector<ImageSize> raster_sizes(const std::filesystem::path& path);

}  // namespace surf::io::openimageio
