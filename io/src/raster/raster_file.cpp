// SPDX-License-Identifier: GPL-3.0-or-later
// EXR, TIFF and PNG.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "files/damaged.h"
#include "image_formats.h"
#include "pyramid.h"
#include "raster_functions.h"
#include "raster_output.h"
#include "stored_pixels.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io::openimageio {
namespace {

constexpr std::int64_t max_values = std::int64_t{1} << 31;
constexpr OIIO::imagesize_t max_drape_pixels = OIIO::imagesize_t{1} << 28;
constexpr int rows_at_a_time = 64;

/// Writes channels [first_channel, end_channel) interleaved, the top row first.
void write_rows(OIIO::ImageOutput& output, const std::string& file, const ImageRows& image,
                std::size_t first_channel, std::size_t end_channel) {
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t channels = end_channel - first_channel;
  std::vector<float> row(width);
  std::vector<float> block;
  for (int first = 0; first < image.height; first += rows_at_a_time) {
    const int end = std::min(first + rows_at_a_time, image.height);
    block.resize(static_cast<std::size_t>(end - first) * width * channels);
    for (std::size_t c = 0; c < channels; ++c) {
      std::size_t at = c;
      for (int y = first; y < end; ++y) {
        image.read(first_channel + c, image.height - 1 - y, row);
        for (std::size_t x = 0; x < width; ++x, at += channels) block[at] = row[x];
      }
    }
    check_written(output.write_scanlines(first, end, 0, OIIO::TypeDesc::FLOAT, block.data()),
                  output, file);
  }
}

/// Bytes of one row of PNG's pixels as they are compressed, by its header; colour tables make them
/// smaller than what is read.
double png_row_bytes(const std::filesystem::path& path, const OIIO::ImageSpec& spec) {
  unsigned char head[26] = {};
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(head), sizeof head);
  const bool has_table = head[25] == 3;
  return spec.width * double(head[24]) / 8 * (has_table ? 1 : spec.nchannels);
}

/// How many times smaller EXR's compression can make pixels. DWA packs one value for 64, and that
/// once more.
double exr_ratio(std::string_view compression) {
  if (compression == "none") return 1;
  if (compression == "pxr24")
    return 4.0 / 3 * deflate_ratio;  // it leaves out one of four bytes first
  return compression.starts_with("dwa") ? 64 * deflate_ratio : deflate_ratio;
}

/// TIFF's are judged as a whole, by check_tiff_structure.
void check_stored(const OIIO::ImageInput& input, const std::filesystem::path& path) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::string_view format = input.format_name();
  double bytes = 0, ratio = deflate_ratio;
  if (format == "openexr") {
    const bool tiles = spec.tile_width > 0 && spec.tile_height > 0;
    bytes = std::max(double(spec.image_bytes(true)), tiles ? double(spec.tile_bytes(true)) : 0.0);
    ratio = exr_ratio(spec.get_string_attribute("compression", "zip"));
  } else if (format == "png") {
    bytes = spec.height * png_row_bytes(path, spec);
  } else {
    bytes = double(spec.image_bytes(true));
    if (format != "jpeg" && format != "bmp")
      ratio = unknown_ratio;  // by a name that does not fit its content
  }
  require_stored(path.string(), bytes, bytes / ratio, std::filesystem::file_size(path));
}

/// Values of all channels, interleaved, the top row first. Whole numbers are left as they are.
std::vector<float> read_values(OIIO::ImageInput& input, const std::string& file) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.deep || spec.depth > 1 || spec.width < 1 || spec.height < 1 || spec.nchannels < 1 ||
      std::int64_t{spec.width} * spec.height > max_values / spec.nchannels) {
    throw FileError(file,
                    fmt::format("{} x {} x {} pixels with {} channels cannot be used", spec.width,
                                spec.height, spec.depth, spec.nchannels),
                    "Use a flat image of ordinary size");
  }
  if (spec.get_int_attribute("Orientation", 1) != 1) {
    throw FileError(file, "its tag says that it is to be turned or mirrored",
                    "Save it upright, without an orientation tag");
  }
  std::vector<float> values(static_cast<std::size_t>(spec.width) *
                            static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(spec.nchannels));
  if (!input.read_image(input.current_subimage(), input.current_miplevel(), 0, spec.nchannels,
                        OIIO::TypeDesc::FLOAT, values.data())) {
    throw FileError(file, fmt::format("its pixels cannot be read: {}", input.geterror()),
                    copy_again);
  }
  double full_scale = 0;  // OpenImageIO maps whole numbers to 0 ... 1 or -1 ... 1
  switch (spec.format.basetype) {
    case OIIO::TypeDesc::UINT8:
      full_scale = 0xff;
      break;
    case OIIO::TypeDesc::INT8:
      full_scale = 0x7f;
      break;
    case OIIO::TypeDesc::UINT16:
      full_scale = 0xffff;
      break;
    case OIIO::TypeDesc::INT16:
      full_scale = 0x7fff;
      break;
    case OIIO::TypeDesc::UINT32:
      full_scale = 0xffffffffU;
      break;
    case OIIO::TypeDesc::INT32:
      full_scale = 0x7fffffff;
      break;
    default:
      return values;
  }
  for (float& value : values) value = static_cast<float>(std::round(double{value} * full_scale));
  return values;
}

Grid<float> extract_channel(const OIIO::ImageSpec& spec, const std::vector<float>& values, int c) {
  Grid<float> grid(spec.width, spec.height);
  std::size_t i = static_cast<std::size_t>(c);
  for (int row = 0; row < spec.height; ++row) {
    for (int x = 0; x < spec.width; ++x, i += static_cast<std::size_t>(spec.nchannels)) {
      grid(x, spec.height - 1 - row) = values[i];
    }
  }
  return grid;
}

Attributes string_attributes(const OIIO::ImageSpec& spec) {
  Attributes attributes;
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    if (attribute.type() != OIIO::TypeDesc::STRING) continue;
    attributes[attribute.name().string()] = attribute.get_string();
  }
  return attributes;
}

/// Adds the channels of the current subimage under the file's names, "L" for lone grey.
void append_channels(OIIO::ImageInput& input, const std::string& file, Image& image) {
  const OIIO::ImageSpec spec = input.spec();
  const std::vector<float> values = read_values(input, file);
  const bool is_exr = std::string_view(input.format_name()) == "openexr";
  for (int c = 0; c < spec.nchannels; ++c) {
    std::string name = spec.channel_name(c);
    if (!is_exr && spec.nchannels <= 2 && name == "Y") name = "L";
    image.channels.push_back({name, "1", extract_channel(spec, values, c)});
  }
}

Attributes attributes_of(const OIIO::ImageSpec& spec) {
  Attributes attributes = string_attributes(spec);
  attributes.merge(parse_description(spec.get_string_attribute("ImageDescription")));
  return attributes;
}

/// The current subimage with what its text says.
Image read_page(OIIO::ImageInput& input, const std::string& file) {
  Image page;
  append_channels(input, file, page);
  const Attributes attributes = attributes_of(input.spec());
  const auto list = attributes.find("image:channels");
  if (list != attributes.end() && page.channels.size() == 1) {
    page.channels.front().name = list->second.substr(0, list->second.find('\t'));
  }
  apply_attributes(attributes, file, page);
  return page;
}

/// A number that semsurf wrote into the text of a page; 1 in files of others.
int number_of(const OIIO::ImageSpec& spec, const char* key) {
  const Attributes attributes = attributes_of(spec);
  const auto found = attributes.find(key);
  int number = 1;
  if (found != attributes.end())
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
  return number;
}

/// What pages there are, of which a TIFF file of ours says more than a plain one.
struct Pages {
  int channels = 1;  ///< pages of the image itself
  int levels = 1;
  bool mip =
      false;  ///< whether levels are levels for OpenImageIO, too, or pages after those of the image

  int of(int channel, int level) const {
    return mip || level == 0 ? channel : channels + channel * (levels - 1) + level - 1;
  }
};

Pages pages_of(OIIO::ImageInput& input) {
  Pages pages;
  pages.mip = std::string_view(input.format_name()) == "openexr";
  pages.channels = std::clamp(number_of(input.spec(), pages_key), 1, 1 << 16);
  if (!pages.mip) {
    pages.levels = std::clamp(number_of(input.spec(), levels_key), 1, 32);
    return pages;
  }
  while (input.seek_subimage(0, pages.levels)) ++pages.levels;
  input.seek_subimage(0, 0);
  return pages;
}

void go_to(OIIO::ImageInput& input, const std::string& file, const Pages& pages, int channel,
           int level) {
  if (input.seek_subimage(pages.of(channel, level), pages.mip ? level : 0)) return;
  throw FileError(file,
                  fmt::format("page {} of {} is missing", pages.of(channel, level) + 1,
                              pages.channels * (pages.mip ? 1 : pages.levels)),
                  copy_again);
}

std::unique_ptr<OIIO::ImageInput> open_raster(const std::filesystem::path& path) {
  require_regular_file(path);
  keep_quiet();
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(path.string(), &config);
  if (!input) {
    throw FileError(path.string(),
                    fmt::format("it cannot be read as an image: {}", OIIO::geterror()),
                    "Check that its content fits its name, or write it again");
  }
  if (std::string_view(input->format_name()) == "tiff") check_tiff_structure(path);
  else check_stored(*input, path);
  return input;
}

/// From grey levels back to values, as well as eight bits allow.
void undo_stretch(Image& image) {
  const auto number = [&](const char* key, double& value) {
    const auto found = image.metadata.find(key);
    if (found == image.metadata.end()) return false;
    const std::string& text = found->second;
    return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{} &&
           std::isfinite(value);
  };
  double low = 0;
  double high = 0;
  if (!number(stretch_low_key, low) || !number(stretch_high_key, high)) return;
  for (float& value : image.channels.front().values.data()) {
    value = static_cast<float>(low + (high - low) * double{value} / 255);
  }
}

void write_png_rows(OIIO::ImageOutput& output, const std::string& target, const std::string& file,
                    const Image& head, int width, int height, const GreyRow& grey) {
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::UINT8);
  spec.attribute("ImageDescription", to_description(head));
  set_resolution(spec, head, 2e7);
  check_written(output.open(target, spec), output, file);
  std::vector<unsigned char> values(static_cast<std::size_t>(width));
  for (int row = 0; row < height; ++row) {
    grey(height - 1 - row, values);
    check_written(output.write_scanline(row, 0, OIIO::TypeDesc::UINT8, values.data()), output,
                  file);
  }
  close_output(output, file);
}

}  // namespace

void write_exr(const std::filesystem::path& target, const std::string& file,
               const ImageRows& rows) {
  const Image& image = rows.head;
  const auto output = create_output("openexr", file);
  OIIO::ImageSpec spec(rows.width, rows.height, static_cast<int>(image.channels.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const Channel& channel : image.channels) spec.channelnames.push_back(channel.name);
  spec.attribute("compression", "zip");
  leave_out_date(spec);
  for (const auto& [key, value] : to_attributes(image)) spec.attribute(key, value);
  check_written(output->open(target.string(), spec), *output, file);
  write_rows(*output, file, rows, 0, image.channels.size());
  close_output(*output, file);
}

void write_tiff(const std::filesystem::path& target, const std::string& file,
                const ImageRows& rows) {
  const Image& image = rows.head;
  const auto output = create_output("tiff", file);
  const double bytes = 4.0 * rows.width * rows.height * static_cast<double>(image.channels.size());
  auto mode = OIIO::ImageOutput::Create;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const Channel& channel = image.channels[c];
    OIIO::ImageSpec spec(rows.width, rows.height, 1, OIIO::TypeDesc::FLOAT);
    Image page = without_channels(image);
    page.channels.push_back({channel.name, channel.unit, {}});
    spec.attribute("ImageDescription", fmt::format("{}{}={}\n", to_description(page), pages_key,
                                                   image.channels.size()));
    leave_out_date(spec);
    spec.attribute("compression", "none");  // ImageJ and others cannot read compressed floats
    if (bytes > 4e9) spec.attribute("tiff:bigtiff", 1);
    set_resolution(spec, image, 4e9);
    check_written(output->open(target.string(), spec, mode), *output, file);
    write_rows(*output, file, rows, c, c + 1);
    mode = OIIO::ImageOutput::AppendSubimage;
  }
  close_output(*output, file);
}

void write_png(const std::filesystem::path& target, const std::string& file, const Image& head,
               int width, int height, const GreyRow& grey) {
  const auto output = create_output("png", file);
  write_png_rows(*output, target.string(), file, head, width, height, grey);
}

std::string png_content(const std::string& file, const Image& head, int width, int height,
                        const GreyRow& grey) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = create_output("png", file);
  output->set_ioproxy(&memory);
  write_png_rows(*output, "memory.png", file, head, width, height, grey);
  return {bytes.begin(), bytes.end()};
}

std::string format_grey_png(const std::string& file, const Grid<std::uint8_t>& grey) {
  const auto output = create_output("png", file);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput target(bytes);
  OIIO::ImageSpec spec(grey.width(), grey.height(), 1, OIIO::TypeDesc::UINT8);
  void* const proxy = &target;
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  check_written(output->open("picture.png", spec), *output, file);
  for (int row = 0; row < grey.height(); ++row) {
    const std::uint8_t* const pixels = &grey(0, grey.height() - 1 - row);
    check_written(output->write_scanline(row, 0, OIIO::TypeDesc::UINT8, pixels), *output, file);
  }
  close_output(*output, file);
  return {bytes.begin(), bytes.end()};
}

Grid<std::uint8_t> parse_grey_png(const std::string& file, std::string_view content) {
  keep_quiet();
  const auto fail = [&](const std::string& reason) {
    throw FileError(file, fmt::format("its picture cannot be read: {}", reason),
                    "Export the file again");
  };
  OIIO::Filesystem::IOMemReader source(const_cast<char*>(content.data()), content.size());
  const auto input = OIIO::ImageInput::open("picture.png", nullptr, &source);
  if (!input) fail(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.image_pixels() > max_drape_pixels) {
    fail(fmt::format("it has {} by {} pixels", spec.width, spec.height));
  }
  Grid<std::uint8_t> grey(spec.width, spec.height);
  for (int row = 0; row < spec.height; ++row) {
    std::uint8_t* const pixels = &grey(0, spec.height - 1 - row);
    if (!input->read_scanlines(0, 0, row, row + 1, 0, 0, 1, OIIO::TypeDesc::UINT8, pixels)) {
      fail(input->geterror());
    }
  }
  return grey;
}

int raster_bits(const std::filesystem::path& path) {
  require_regular_file(path);
  keep_quiet();
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input)
    throw FileError(path.string(), "it cannot be read as an image: " + OIIO::geterror(),
                    "Check its content");
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.format.is_floating_point()) return 0;
  return spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * spec.format.size()));
}

Image read_raster(const std::filesystem::path& path, int level) {
  const std::string file = path.string();
  const auto input = open_raster(path);
  const Pages pages = pages_of(*input);
  const int height = input->spec().height;
  Image image;
  for (int channel = 0; channel < pages.channels; ++channel) {
    go_to(*input, file, pages, channel, level);
    Image page = read_page(*input, file);
    if (channel == 0) image = std::move(page);
    else std::move(page.channels.begin(), page.channels.end(), std::back_inserter(image.channels));
  }
  if (std::string_view(input->format_name()) == "png") undo_stretch(image);
  if (pages.mip)
    image = placed_at_level(std::move(image), height, level);  // its text is that of the whole file
  return image;
}

std::vector<ImageSize> raster_sizes(const std::filesystem::path& path) {
  const auto input = open_raster(path);
  const Pages pages = pages_of(*input);
  std::vector<ImageSize> sizes;
  for (int level = 0; level < pages.levels; ++level) {
    go_to(*input, path.string(), pages, 0, level);
    sizes.push_back({input->spec().width, input->spec().height});
  }
  return sizes;
}

}  // namespace surf::io::openimageio
