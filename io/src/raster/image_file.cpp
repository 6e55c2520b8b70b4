// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "grey_picture.h"
#include "hdf5/hdf5_library.h"
#include "image_formats.h"
#include "pyramid.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

enum class Format { none, exr, tiff, png, vti, hspy };

Format format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return Format::exr;
  if (extension == ".tif" || extension == ".tiff") return Format::tiff;
  if (extension == ".png") return Format::png;
  if (extension == ".vti") return Format::vti;
  if (extension == ".hspy") return Format::hspy;
  return Format::none;
}

enum class Use { read, write };

Format known_format_of(const std::filesystem::path& path, Use use = Use::write) {
  const Format format = format_of(path);
  if (format == Format::none) {
    throw UsageError(
        path.string(),
        fmt::format("'{}' is not an image format known here", path.extension().string()),
        "Use .exr, .tif, .png, .vti or .hspy");
  }
  if (format == Format::hspy) {
    if (use == Use::read)
      throw UsageError(
          path.string(), "files of HyperSpy are written, not read",
          "Read it in Python by hyperspy.api.load, or keep the image as .exr or .tif, too");
    hdf5_library(path.string());
  } else if (format != Format::vti) {
    require_raster(path.string());
  } else if (use == Use::write) {
    require_vtk(path.string());
  }
  return format;
}

std::string channel_names(const Image& image) {
  std::string names;
  for (const Channel& channel : image.channels) {
    names += (names.empty() ? "" : ", ") + channel.name;
  }
  return names;
}

const Channel& find_channel(const Image& image, const std::string& name,
                            const std::string& subject) {
  if (name.empty() && !image.channels.empty()) return image.channels.front();
  const Channel* const channel = image.find(name);
  if (!channel) {
    throw UsageError(subject, fmt::format("there is no channel '{}'", name),
                     fmt::format("Choose one of: {}", channel_names(image)));
  }
  return *channel;
}

bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; });
}

/// What all formats can hold.
void check_image(const ImageRows& rows, const std::string& file) {
  Image image = rows.head;
  for (Channel& channel : image.channels) channel.values = Grid<float>(1, 1);
  validate(image, file.c_str());
  if (rows.width < 1 || rows.height < 1) {
    throw InvalidInput(file, "the image has no pixels", "Give it at least one");
  }
  for (const Channel& channel : image.channels) {
    if (has_control_character(channel.name) || has_control_character(channel.unit)) {
      throw InvalidInput(file, "the name or unit of a channel holds a control character",
                         "Use plain text");
    }
  }
  for (const auto& [key, value] : image.metadata) {
    if (key.empty() || has_control_character(key) || value.find('\0') != std::string::npos) {
      throw InvalidInput(file, fmt::format("the metadata '{}' cannot be stored", key),
                         "Use plain text");
    }
  }
}

void write_vti_at_once(const std::filesystem::path& target, const std::string& file,
                       const ImageRows& rows) {
  write_vti(target, file, to_image(rows));
}

}  // namespace

bool in_tiles(Layout layout, const ImageSize& size) {
  if (layout != Layout::automatic) return layout == Layout::tiles;
  return std::int64_t{size.width} * size.height > most_pixels_in_rows;
}

std::int64_t stored_pixels(Layout layout, const ImageSize& size) {
  if (!in_tiles(layout, size)) return std::int64_t{size.width} * size.height;
  const auto filled = [](int n) {
    return std::int64_t{(n + tile_edge - 1) / tile_edge * tile_edge};
  };
  std::int64_t pixels = 0;
  for (const ImageSize& level : pyramid_sizes(size.width, size.height, tile_edge))
    pixels += filled(level.width) * filled(level.height);
  return pixels;
}

void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options) {
  known_format_of(path);
  validate(image, path.c_str());
  write_image(path, rows_of(image), options);
}

void write_image(const std::filesystem::path& path, const ImageRows& rows,
                 const ImageWriteOptions& options) {
  const std::string file = path.string();
  const Format format = known_format_of(path);
  check_image(rows, file);
  const Channel& channel = find_channel(rows.head, options.channel, file);
  const auto number = static_cast<std::size_t>(&channel - rows.head.channels.data());
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    const bool tiles = in_tiles(options.layout, {rows.width, rows.height});
    switch (format) {
      case Format::exr:
        if (tiles) write_tiled_exr(temporary, file, rows, options.labels);
        else write_exr(temporary, file, rows);
        break;
      case Format::tiff:
        if (tiles) write_tiled_tiff(temporary, file, rows, options.labels);
        else write_tiff(temporary, file, rows);
        break;
      case Format::png:
        write_grey_picture(temporary, file, rows, number);
        break;
      case Format::vti:
        write_vti_at_once(temporary, file, rows);
        break;
      case Format::hspy:
        hdf5_library(file).write_hspy(temporary, file, to_image(rows));
        break;
      case Format::none:
        break;
    }
  });
}

void check_image_target(const std::filesystem::path& path, const Image* image,
                        const ImageWriteOptions& options) {
  known_format_of(path);
  if (image) find_channel(*image, options.channel, path.string());
  check_writable(path);
}

namespace {

Format readable_format_of(const std::filesystem::path& path) {
  const Format format = known_format_of(path, Use::read);
  require_regular_file(path);
  return format;
}

}  // namespace

Image read_image(const std::filesystem::path& path, int level) {
  const Format format = readable_format_of(path);
  const bool vti = format == Format::vti;
  const int levels = level == 0 ? 1 : vti ? 1 : static_cast<int>(raster_sizes(path).size());
  if (level < 0 || level >= levels)
    throw UsageError(path.string(), fmt::format("there is no level {}", level),
                     levels == 1 ? std::string("It has no pyramid: leave the level out")
                                 : fmt::format("Choose one of 0 to {}", levels - 1));
  Image image = vti ? read_vti(path) : read_raster(path, level);
  try {
    validate(image, path.string().c_str());
  } catch (const InvalidInput& error) {
    throw FileError(error.subject(), error.reason(), error.remedy());
  }
  return image;
}

bool states_pixel_size(const Image& image) {
  return image.pitch_x_nm != 1 || image.pitch_y_nm != 1 || !image.metadata.empty() ||
         image.find("z_nm");
}

ImageLevel read_image_within(const std::filesystem::path& path, std::int64_t most_pixels) {
  ImageLevel out;
  if (readable_format_of(path) != Format::vti) {
    const std::vector<ImageSize> sizes = raster_sizes(path);
    out.levels = static_cast<int>(sizes.size());
    out.whole = sizes.front();
    const auto pixels = [&](int level) {
      const ImageSize& size = sizes[static_cast<std::size_t>(level)];
      return std::int64_t{size.width} * size.height;
    };
    while (out.level + 1 < out.levels && pixels(out.level) > most_pixels) ++out.level;
  }
  out.image = read_image(path, out.level);
  if (out.level == 0) out.whole = {out.image.width(), out.image.height()};
  return out;
}

bool is_image_file(const std::filesystem::path& path) { return format_of(path) != Format::none; }

HeightField to_height_field(const Image& image, const std::string& channel, double z_unit_nm) {
  const Channel& heights = find_channel(image, channel, "height field");
  const Channel* const mask = image.find("valid");
  HeightField field;
  field.placement() = image.placement();
  field.z_nm = Grid<double>(image.width(), image.height());
  Mask valid(image.width(), image.height(), 1);
  bool has_holes = false;
  for (std::size_t i = 0; i < heights.values.size(); ++i) {
    const float value = heights.values.data()[i];
    if (!std::isfinite(value) || (mask && mask->values.data()[i] == 0)) {
      valid.data()[i] = 0;
      has_holes = true;
    } else {
      field.z_nm.data()[i] = double{value} * z_unit_nm;
    }
  }
  if (has_holes) field.valid = std::move(valid);
  validate(field, heights.name.c_str());
  return field;
}

std::string image_library_versions() { return SEMSURF_IMAGE_LIBRARIES; }

}  // namespace surf::io
