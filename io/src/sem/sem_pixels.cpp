// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_pixels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "files/damaged.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

constexpr int tag_width = 256, tag_height = 257, tag_bits = 258, tag_compression = 259,
              tag_photometric = 262;
constexpr int tag_strips = 273, tag_samples = 277, tag_strip_bytes = 279, tag_palette = 320;

// Of a picture that is a grey one with something drawn over it.
constexpr double most_in_colour = 0.1;

bool is_plain_palette(const TiffPage& page) {
  const TiffTag* const palette = page.find(tag_palette);
  return page.number(tag_photometric) == 3.0 && page.number(tag_compression).value_or(1) == 1.0 &&
         page.number(tag_bits) == 8.0 && page.number(tag_samples).value_or(1) == 1.0 &&
         page.find(tag_strips) && page.find(tag_strip_bytes) && palette &&
         palette->count() == 3 * 256;
}

/// Which of the 256 numbers are shown in a colour.
std::array<bool, 256> coloured(const TiffTag& palette) {
  std::array<bool, 256> in_colour{};
  for (std::size_t i = 0; i < 256; ++i) {
    const auto red = palette.number(i), green = palette.number(256 + i),
               blue = palette.number(512 + i);
    in_colour[i] = red != green || green != blue;
  }
  return in_colour;
}

std::string strip_bytes(const TiffPage& page, const Bytes& file, std::size_t wanted) {
  const TiffTag &places = *page.find(tag_strips), &sizes = *page.find(tag_strip_bytes);
  std::string bytes;
  for (std::size_t i = 0; i < std::min(places.count(), sizes.count()) && bytes.size() < wanted;
       ++i) {
    const auto place = places.whole(i), size = sizes.whole(i);
    if (!place || !size) break;
    bytes += file.part(*place, *size).text();
  }
  if (bytes.size() < wanted) file.fail("its pixels are not all there", copy_again);
  return bytes;
}

void tell_of_colour(SemPixels& pixels, const std::string& file) {
  const auto out = std::count(pixels.valid.data().begin(), pixels.valid.data().end(), 0);
  if (out == 0) {
    pixels.valid = {};
    return;
  }
  const auto all = static_cast<double>(pixels.valid.size());
  if (static_cast<double>(out) > most_in_colour * all)
    throw InvalidInput(
        file, fmt::format("{:.0f} % of it is in colour", 100 * static_cast<double>(out) / all),
        "Give the microscope's own grey image");
  pixels.notes.push_back(
      fmt::format("{} pixels in colour are taken for annotations and left out", out));
}

const Channel* find(const Image& image, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const Channel* const channel = image.find(name)) return channel;
  return nullptr;
}

}  // namespace

SemPixels palette_pixels(const TiffPage& page, const Bytes& file) {
  SemPixels pixels;
  if (!is_plain_palette(page)) return pixels;
  const double width = page.number(tag_width).value_or(0),
               height = page.number(tag_height).value_or(0);
  if (!(width >= 1 && height >= 1 && width * height <= static_cast<double>(file.size())))
    file.fail(fmt::format("{:g} x {:g} pixels do not fit into it", width, height), copy_again);
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  const std::string bytes =
      strip_bytes(page, file, static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  const auto in_colour = coloured(*page.find(tag_palette));
  pixels.values = Grid<double>(w, h);
  pixels.valid = Mask(w, h, 1);
  pixels.bits = 8;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto index = static_cast<unsigned char>(
          bytes[static_cast<std::size_t>(h - 1 - y) * static_cast<std::size_t>(w) +
                static_cast<std::size_t>(x)]);
      pixels.values(x, y) = index;
      pixels.valid(x, y) = !in_colour[index];
    }
  tell_of_colour(pixels, file.file());
  return pixels;
}

SemPixels grey_pixels(const Image& image, const std::string& channel, const std::string& file) {
  SemPixels pixels;
  std::vector<std::string> names;
  for (const Channel& c : image.channels) names.push_back(c.name);
  const Channel* const red = find(image, {"R"});
  const Channel* const green = find(image, {"G"});
  const Channel* const blue = find(image, {"B"});
  const bool rgb = channel.empty() && red && green && blue;
  const Channel* chosen =
      channel.empty() ? (rgb ? red : &image.channels.front()) : image.find(channel);
  if (!chosen)
    throw UsageError(file, fmt::format("it has no channel '{}'", channel),
                     fmt::format("Choose one of {}", fmt::join(names, ", ")));
  const Channel* const mask = image.find("valid");
  if (image.channels.size() > 1 && !rgb) pixels.channel = chosen->name;
  pixels.values = Grid<double>(image.width(), image.height());
  pixels.valid = Mask(image.width(), image.height(), 1);
  std::size_t holes = 0;
  for (std::size_t i = 0; i < pixels.values.size(); ++i) {
    const double value = chosen->values.data()[i];
    const bool there =
        std::isfinite(value) && !(mask && mask != chosen && mask->values.data()[i] == 0);
    pixels.values.data()[i] = there ? value : 0;
    const bool grey = !rgb || (green->values.data()[i] == red->values.data()[i] &&
                               blue->values.data()[i] == red->values.data()[i]);
    holes += !there;
    pixels.valid.data()[i] = there && grey;
  }
  if (rgb) {
    tell_of_colour(pixels, file);
  } else if (holes == 0) {
    pixels.valid = {};
  } else if (holes == pixels.valid.size()) {
    throw InvalidInput(file, "it has no pixel with a number",
                       "Give another image, or another of its channels");
  }
  return pixels;
}

}  // namespace surf::io
