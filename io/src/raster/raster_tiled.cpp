// SPDX-License-Identifier: GPL-3.0-or-later
// EXR and TIFF in tiles, with smaller copies for viewing.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "image_formats.h"
#include "pyramid.h"
#include "raster_functions.h"
#include "raster_output.h"

namespace surf::io::openimageio {
namespace {

constexpr int tile = tile_edge;

void use_tiles(OIIO::ImageSpec& spec) {
  spec.tile_width = spec.tile_height = tile;
  spec.tile_depth = 1;
}

// A row of a channel, counted from the top.
using CopyRow = std::function<void(std::size_t channel, int row, std::span<float> into)>;

/// Writes channels [first_channel, end_channel) of one level, a row of tiles at a time. The image
/// itself goes into the pyramid on the way. Tiles that reach beyond the image are filled up here:
/// libraries leave what was in memory.
void write_level(OIIO::ImageOutput& output, const std::string& file, ImageSize size,
                 std::size_t first_channel, std::size_t end_channel, const CopyRow& copy_row,
                 Pyramid* add_to) {
  const auto width = static_cast<std::size_t>(size.width);
  const std::size_t channels = end_channel - first_channel;
  std::vector<std::vector<float>> planes(channels);
  std::vector<float> block(std::size_t{tile} * tile * channels);
  for (int first = 0; first < size.height; first += tile) {
    const int end = std::min(first + tile, size.height);
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<float>& plane = planes[c];
      plane.resize(static_cast<std::size_t>(end - first) * width);
      for (int y = first; y < end; ++y)
        copy_row(first_channel + c, y,
                 std::span(plane).subspan(static_cast<std::size_t>(y - first) * width, width));
      if (add_to) add_to->add(first_channel + c, first, plane);
    }
    for (int left = 0; left < size.width; left += tile) {
      const int right = std::min(left + tile, size.width);
      std::ranges::fill(block, 0.0f);
      for (std::size_t c = 0; c < channels; ++c)
        for (int y = first; y < end; ++y) {
          const float* from = planes[c].data() + static_cast<std::size_t>(y - first) * width;
          float* into = block.data() + static_cast<std::size_t>(y - first) * tile * channels + c;
          for (int x = left; x < right; ++x)
            into[static_cast<std::size_t>(x - left) * channels] = from[x];
        }
      check_written(output.write_tile(left, first, 0, OIIO::TypeDesc::FLOAT, block.data()), output,
                    file);
    }
    if (add_to) add_to->release();
  }
}

CopyRow rows_from_top(const ImageRows& rows) {
  return [&rows](std::size_t channel, int y, std::span<float> into) {
    rows.read(channel, rows.height - 1 - y, into);
  };
}

CopyRow rows_of_level(const Pyramid& pyramid, int level) {
  return [&pyramid, level](std::size_t channel, int y, std::span<float> into) {
    if (y % tile == 0) pyramid.release();
    std::ranges::copy(pyramid.row(level, channel, y), into.begin());
  };
}

std::string folder_of(const std::filesystem::path& target) {
  const auto folder = target.parent_path();
  return folder.empty() ? "." : folder.string();
}

}  // namespace

void write_tiled_exr(const std::filesystem::path& target, const std::string& file,
                     const ImageRows& rows, std::span<const std::string> labels) {
  const Image& image = rows.head;
  Pyramid pyramid(rows, labels, 1, folder_of(target));  // the format wants all levels
  const auto output = create_output("openexr", file);
  for (int level = 0; level < pyramid.levels(); ++level) {
    const ImageSize size = pyramid.size(level);
    OIIO::ImageSpec spec(size.width, size.height, static_cast<int>(image.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    use_tiles(spec);
    spec.channelnames.clear();
    for (const Channel& channel : image.channels) spec.channelnames.push_back(channel.name);
    spec.attribute("compression", "zip");
    spec.attribute("textureformat", "Plain Texture");  // else OpenImageIO writes one level only
    spec.attribute("openexr:roundingmode", 1);         // up
    leave_out_date(spec);
    for (const auto& [key, value] : to_attributes(image)) spec.attribute(key, value);
    check_written(
        output->open(target.string(), spec,
                     level == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendMIPLevel),
        *output, file);
    write_level(*output, file, size, 0, image.channels.size(),
                level == 0 ? rows_from_top(rows) : rows_of_level(pyramid, level),
                level == 0 ? &pyramid : nullptr);
    if (level == 0) pyramid.finish();
  }
  close_output(*output, file);
}

// All channels, then the smaller sizes of the first, of the second, and so on: who takes pages for
// channels finds them first, and GIS programs take what is marked as reduced for overviews of the
// first.
void write_tiled_tiff(const std::filesystem::path& target, const std::string& file,
                      const ImageRows& rows, std::span<const std::string> labels) {
  const Image& image = rows.head;
  Pyramid pyramid(rows, labels, tile, folder_of(target));
  const auto output = create_output("tiff", file);
  const double bytes =
      4.0 * 4 / 3 * rows.width * rows.height * static_cast<double>(image.channels.size());
  auto mode = OIIO::ImageOutput::Create;
  const auto write_page = [&](std::size_t c, int level) {
    const ImageSize size = pyramid.size(level);
    OIIO::ImageSpec spec(size.width, size.height, 1, OIIO::TypeDesc::FLOAT);
    use_tiles(spec);
    Image page = placed_at_level(without_channels(image), rows.height, level);
    page.channels.push_back({image.channels[c].name, image.channels[c].unit, {}});
    spec.attribute("ImageDescription",
                   fmt::format("{}{}={}\n{}={}\n", to_description(page), pages_key,
                               image.channels.size(), levels_key, pyramid.levels()));
    leave_out_date(spec);
    spec.attribute("compression", "none");
    if (bytes > 4e9) spec.attribute("tiff:bigtiff", 1);
    if (level > 0) spec.attribute("tiff:subfiletype", 1);
    set_resolution(spec, page, 4e9);
    check_written(output->open(target.string(), spec, mode), *output, file);
    mode = OIIO::ImageOutput::AppendSubimage;
    write_level(*output, file, size, c, c + 1,
                level == 0 ? rows_from_top(rows) : rows_of_level(pyramid, level),
                level == 0 ? &pyramid : nullptr);
  };
  for (std::size_t c = 0; c < image.channels.size(); ++c) write_page(c, 0);
  pyramid.finish();
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    for (int level = 1; level < pyramid.levels(); ++level) write_page(c, level);
  close_output(*output, file);
}

}  // namespace surf::io::openimageio
