// SPDX-License-Identifier: GPL-3.0-or-later
// EXR, TIFF and PNG by the module `raster`.
#include "raster_library.h"

#include "files/module_for.h"

namespace surf::io {
namespace {

const RasterLibrary& library(const std::string& file) { return module_for<RasterLibrary>(file); }

}  // namespace

void write_exr(const std::filesystem::path& target, const std::string& file,
               const ImageRows& rows) {
  library(file).write_exr(target, file, rows);
}

void write_tiff(const std::filesystem::path& target, const std::string& file,
                const ImageRows& rows) {
  library(file).write_tiff(target, file, rows);
}

void write_tiled_exr(const std::filesystem::path& target, const std::string& file,
                     const ImageRows& rows, std::span<const std::string> labels) {
  library(file).write_tiled_exr(target, file, rows, labels);
}

void write_tiled_tiff(const std::filesystem::path& target, const std::string& file,
                      const ImageRows& rows, std::span<const std::string> labels) {
  library(file).write_tiled_tiff(target, file, rows, labels);
}

void write_png(const std::filesystem::path& target, const std::string& file, const Image& head,
               int width, int height, const GreyRow& grey) {
  library(file).write_png(target, file, head, width, height, grey);
}

std::string png_content(const std::string& file, const Image& head, int width, int height,
                        const GreyRow& grey) {
  return library(file).png_content(file, head, width, height, grey);
}

std::string format_grey_png(const std::string& file, const Grid<std::uint8_t>& grey) {
  return library(file).format_grey_png(file, grey);
}

Grid<std::uint8_t> parse_grey_png(const std::string& file, std::string_view content) {
  return library(file).parse_grey_png(file, content);
}

int raster_bits(const std::filesystem::path& path) {
  return library(path.string()).raster_bits(path);
}

Image read_raster(const std::filesystem::path& path, int level) {
  return library(path.string()).read_raster(path, level);
}

std::vector<ImageSize> raster_sizes(const std::filesystem::path& path) {
  return library(path.string()).raster_sizes(path);
}

void require_raster(const std::string& file) { library(file); }

}  // namespace surf::io
