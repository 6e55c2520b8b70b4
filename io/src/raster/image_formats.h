// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "surf/core/image.h"
#include "surf/core/image_rows.h"
#include "surf/io/image_file.h"

namespace surf::io {

// Functions called by read_image and write_image, by image library. Writers get the path to write
// to and the name for messages.

void write_exr(const std::filesystem::path& target, const std::string& file, const ImageRows& rows);
void write_tiff(const std::filesystem::path& target, const std::string& file,
                const ImageRows& rows);
/// Write tiles and smaller sizes. For channels named in `labels` see Pyramid.
void write_tiled_exr(const std::filesystem::path& target, const std::string& file,
                     const ImageRows& rows, std::span<const std::string> labels);
void write_tiled_tiff(const std::filesystem::path& target, const std::string& file,
                      const ImageRows& rows, std::span<const std::string> labels);
void write_vti(const std::filesystem::path& target, const std::string& file, const Image& image);
/// The same as bytes.
std::string vti_content(const std::string& file, const Image& image);

/// Sets a row of a grey picture; 0 is black; row 0 is the lowest.
using GreyRow = std::function<void(int y, std::span<unsigned char> row)>;

/// Writes a grey picture. `head` gives its text, with the name and unit of one channel.
void write_png(const std::filesystem::path& target, const std::string& file, const Image& head,
               int width, int height, const GreyRow& grey);
/// The same as bytes.
std::string png_content(const std::string& file, const Image& head, int width, int height,
                        const GreyRow& grey);

/// The content of an 8-bit grey PNG file without any text. Sample (0, 0) is the lower-left pixel.
/// Equal pixels give equal bytes.
std::string format_grey_png(const std::string& file, const Grid<std::uint8_t>& grey);
/// The pixels of a PNG file as 8-bit greys; of colours the first channel. `content` is the content
/// of the file. Throws FileError.
Grid<std::uint8_t> parse_grey_png(const std::string& file, std::string_view content);

/// Throws FileError if a TIFF file is cut off. libtiff reads the missing parts as absent text and
/// black pixels.
void check_tiff_structure(const std::filesystem::path& path);

/// Bits per number on the first page; 0: floats. Throws FileError.
int raster_bits(const std::filesystem::path& path);

/// Reads EXR, TIFF and PNG. For files with several sizes, `level` 0 is the largest.
Image read_raster(const std::filesystem::path& path, int level = 0);
/// The width and height of all sizes.
std::vector<ImageSize> raster_sizes(const std::filesystem::path& path);
Image read_vti(const std::filesystem::path& path);

/// Throw Unsupported, naming `file`, if the module is missing that reads and writes EXR, TIFF and
/// PNG, or that writes VTK's files.
void require_raster(const std::string& file);
void require_vtk(const std::string& file);

// How an image's placement and metadata are stored as text in files. Metadata KEY is stored as
// "semsurf:KEY" (no file format gives that prefix a meaning of its own). Placement is stored as
// "image:pitch_x_nm" and so on. Names and units of the channels, in their order, are stored as
// "image:channels" with one line "NAME<tab>UNIT" each. Empty values are left out, because
// OpenImageIO loses them.

/// The image's placement and metadata alone.
Image without_channels(const Image& image);

using Attributes = std::map<std::string, std::string>;

Attributes to_attributes(const Image& image);

/// Restores the attributes of `to_attributes`: placement, metadata, units and order of the channels
/// that `image` already has. Unknown attributes are ignored.
void apply_attributes(const Attributes& attributes, const std::string& file, Image& image);

/// Formats all attributes as lines "KEY=VALUE", for formats that have one text per picture.
std::string to_description(const Image& image);
Attributes parse_description(std::string_view text);

// Metadata keys of a stretched PNG: the values shown as black and as white.
inline constexpr const char* stretch_low_key = "png.stretch_low";
inline constexpr const char* stretch_high_key = "png.stretch_high";

}  // namespace surf::io
