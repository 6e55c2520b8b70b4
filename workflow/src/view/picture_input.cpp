// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/picture_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <system_error>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/scan_parameters.h"

namespace surf::workflow {
namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

bool is_colour(const std::string& name) {
  return name == "R" || name == "G" || name == "B" || name == "A";
}

/// A photograph becomes one picture of its brightness (Rec. 709): three almost equal ones help
/// nobody.
void join_colours(Image& image) {
  const Channel *r = image.find("R"), *g = image.find("G"), *b = image.find("B");
  if (!r || !g || !b) return;
  Channel grey{"brightness", r->unit, Grid<float>(image.width(), image.height())};
  for (std::size_t i = 0; i < grey.values.size(); ++i)
    grey.values.data()[i] = 0.2126f * r->values.data()[i] + 0.7152f * g->values.data()[i] +
                            0.0722f * b->values.data()[i];
  std::erase_if(image.channels, [](const Channel& channel) { return is_colour(channel.name); });
  image.channels.insert(image.channels.begin(), std::move(grey));
}

/// Formats that hold a pitch hold metadata of ours too; a plain picture has neither.
bool says_its_scale(const Image& image) {
  return image.pitch_x_nm != 1 || image.pitch_y_nm != 1 || !image.metadata.empty();
}

void check_channel(const Image& image, const FileChannel& input) {
  if (input.channel.empty() || image.find(input.channel)) return;
  std::vector<std::string> names;
  for (const Channel& channel : image.channels) names.push_back(channel.name);
  throw UsageError(input.file.string(), fmt::format("there is no channel '{}'", input.channel),
                   fmt::format("Choose one of: {}", fmt::join(names, ", ")));
}

io::WebImage read_scan_channel(const FileChannel& input, const GivenPitch& given) {
  const auto channels = io::height_channels(input.file);
  std::string unit = "nm";
  for (std::size_t i = 0; i < channels.size(); ++i)
    if ((channels[i].name == input.channel || std::to_string(i + 1) == input.channel) &&
        !channels[i].is_height)
      unit = channels[i].z_unit;
  io::HeightReadOptions options{input.channel, {}, given.x_nm, given.y_nm};
  if (unit != "nm") options.z_unit_nm = 1;  // its own unit stays
  const io::HeightFieldFile file = io::read_height_field(input.file, options);
  const HeightField& field = file.field;
  io::WebImage picture{input.file.filename().string(), {}};
  picture.image.placement() = field.placement();
  picture.image.metadata = file.metadata;
  Channel channel{file.channel.empty() ? "values" : file.channel, unit,
                  Grid<float>(field.z_nm.width(), field.z_nm.height())};
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x)
      channel.values(x, y) = field.is_valid(x, y) ? static_cast<float>(field.z_nm(x, y))
                                                  : std::numeric_limits<float>::quiet_NaN();
  picture.image.channels.push_back(std::move(channel));
  return picture;
}

}  // namespace

io::WebImage read_plain_picture(const FileChannel& input, const GivenPitch& given) {
  io::WebImage picture{input.file.filename().string(), io::read_image(input.file)};
  join_colours(picture.image);
  std::erase_if(picture.image.channels, [](const Channel& channel) { return channel.name == "A"; });
  picture.has_scale = says_its_scale(picture.image);
  if (!picture.has_scale && given.x_nm) {
    picture.image.pitch_x_nm = *given.x_nm;
    picture.image.pitch_y_nm = *given.y_nm;
    picture.has_scale = true;
  }
  check_channel(picture.image, input);
  return picture;
}

void describe(ParameterVisitor& visit, GivenPitch& pitch) {
  visit.form(
      {.name = "picture.pixel_size",
       .help = "Distance of neighbouring pixels, 2nm or 2nmx3nm, of pictures "
               "that do not say",
       .unit = Unit::nm,
       .form = "LENGTH"},
      [&] {
        if (!pitch.x_nm) return std::string();
        return format_exact(*pitch.x_nm) + "x" + format_exact(pitch.y_nm.value_or(*pitch.x_nm));
      },
      [&](std::string_view text, const std::string& subject) {
        const auto [x, y] = io::parse_pitch_nm(text, subject);
        pitch = {x, y};
      });
}

FileChannel parse_file_channel(const std::string& text) {
  if (is_file(text)) return {text, {}};
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon + 1 < text.size() && is_file(text.substr(0, colon)))
    return {text.substr(0, colon), text.substr(colon + 1)};
  throw FileError(text, "there is no such file",
                  "Check the name; a channel is given as FILE:CHANNEL");
}

io::WebImage read_picture(const FileChannel& input, const GivenPitch& given) {
  return io::is_height_field_file(input.file) ? read_scan_channel(input, given)
                                              : read_plain_picture(input, given);
}

PlacedPicture read_placed_picture(const FileChannel& input, const GivenPitch& given) {
  PlacedPicture placed{read_picture(input, given), input.channel};
  if (!placed.picture.has_scale)
    throw InvalidInput(input.file.string(), "the picture does not say how large its pixels are",
                       "Give their size, as `picture.pixel_size=2nm`");
  if (input.channel.empty() || !placed.picture.image.find(input.channel))
    placed.channel = placed.picture.image.channels.front().name;
  return placed;
}

}  // namespace surf::workflow
