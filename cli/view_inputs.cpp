// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/mesh_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "terminal.h"

namespace surf::cli {
namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

bool is_colour(const std::string& name) { return name == "R" || name == "G" || name == "B" || name == "A"; }

/// A photograph becomes one picture of its brightness (Rec. 709): three almost equal ones help nobody.
void join_colours(Image& image) {
  const Channel *r = image.find("R"), *g = image.find("G"), *b = image.find("B");
  if (!r || !g || !b) return;
  Channel grey{"brightness", r->unit, Grid<float>(image.width(), image.height())};
  for (std::size_t i = 0; i < grey.values.size(); ++i)
    grey.values.data()[i] =
        0.2126f * r->values.data()[i] + 0.7152f * g->values.data()[i] + 0.0722f * b->values.data()[i];
  std::erase_if(image.channels, [](const Channel& channel) { return is_colour(channel.name); });
  image.channels.insert(image.channels.begin(), std::move(grey));
}

/// Formats that hold a pitch hold metadata of ours too; a plain picture has neither.
bool says_its_scale(const Image& image) {
  return image.pitch_x_nm != 1 || image.pitch_y_nm != 1 || !image.metadata.empty();
}

const Channel* height_channel(const Image& image, const std::string& wanted) {
  if (!wanted.empty()) {
    const Channel* channel = image.find(wanted);
    return channel && channel->unit == "nm" ? channel : nullptr;
  }
  for (const Channel& channel : image.channels)
    if (channel.unit == "nm" && !channel.name.ends_with(".stderr")) return &channel;
  return nullptr;
}

void check_channel(const Image& image, const FileChannel& input) {
  if (input.channel.empty() || image.find(input.channel)) return;
  std::vector<std::string> names;
  for (const Channel& channel : image.channels) names.push_back(channel.name);
  throw UsageError(input.file.string(), fmt::format("there is no channel '{}'", input.channel),
                   fmt::format("Choose one of: {}", fmt::join(names, ", ")));
}

io::WebImage read_picture(const FileChannel& input, const ViewReading& reading) {
  io::WebImage picture{input.file.filename().string(), io::read_image(input.file)};
  join_colours(picture.image);
  std::erase_if(picture.image.channels, [](const Channel& channel) { return channel.name == "A"; });
  picture.has_scale = says_its_scale(picture.image);
  if (!picture.has_scale && reading.pitch_x_nm) {
    picture.image.pitch_x_nm = *reading.pitch_x_nm;
    picture.image.pitch_y_nm = *reading.pitch_y_nm;
    picture.has_scale = true;
  }
  check_channel(picture.image, input);
  return picture;
}

io::WebImage read_scan_channel(const FileChannel& input, const ViewReading& reading) {
  const auto channels = io::height_channels(input.file);
  std::string unit = "nm";
  for (std::size_t i = 0; i < channels.size(); ++i)
    if ((channels[i].name == input.channel || std::to_string(i + 1) == input.channel) && !channels[i].is_height)
      unit = channels[i].z_unit;
  io::HeightReadOptions options{input.channel, {}, reading.pitch_x_nm, reading.pitch_y_nm};
  if (unit != "nm") options.z_unit_nm = 1;   // its own unit stays
  const io::HeightFieldFile file = io::read_height_field(input.file, options);
  const HeightField& field = file.field;
  io::WebImage picture{input.file.filename().string(), {}};
  picture.image.pitch_x_nm = field.pitch_x_nm;
  picture.image.pitch_y_nm = field.pitch_y_nm;
  picture.image.origin_x_nm = field.origin_x_nm;
  picture.image.origin_y_nm = field.origin_y_nm;
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

class Adder {
 public:
  Adder(const FileChannel& input, const ViewReading& reading, io::WebPage& page)
      : input_(input), reading_(reading), page_(page) {}

  void add_field(HeightField field, const std::string& name, std::map<std::string, std::string> metadata,
                 std::vector<io::WebScalar> scalars = {}) {
    io::WebSurface surface;
    surface.name = unique_name(page_, name);
    surface.metadata = std::move(metadata);
    if (reading_.step > 1) {
      const HeightField fine = std::move(field);
      field = every_sample(fine, reading_.step);
      note(fmt::format("every {} sample of {} x {}: {} x {} on the page", ordinal(reading_.step), fine.z_nm.width(),
                       fine.z_nm.height(), field.z_nm.width(), field.z_nm.height()));
      for (io::WebScalar& scalar : scalars) scalar.values = thinned(scalar.values, fine);
      surface.metadata["view.step"] = std::to_string(reading_.step);
    }
    if (reading_.tolerance_nm) {
      ThinSummary summary;
      surface.shape = thin_height_field(field, *reading_.tolerance_nm, summary);
      note(fmt::format("{} triangles instead of {}, nowhere more than {} off", summary.triangles_after,
                       summary.triangles_before, format_length(summary.deviation_nm)));
      surface.metadata["view.deviation_nm"] = format_exact(summary.deviation_nm);
      if (!scalars.empty())
        note("with --tolerance its other channels are left out; --scalar lays one on what remains");
    } else {
      surface.shape = std::move(field);
      surface.scalars = std::move(scalars);
    }
    page_.surfaces.push_back(std::move(surface));
  }

  void add_scan() {
    const io::HeightFieldFile file =
        io::read_height_field(input_.file, {input_.channel, {}, reading_.pitch_x_nm, reading_.pitch_y_nm});
    for (const std::string& text : file.notes) note(text);
    std::map<std::string, std::string> metadata = file.metadata;
    metadata["file.format"] = file.format;
    if (!file.channel.empty()) metadata["file.channel"] = file.channel;
    add_field(file.field, input_.file.stem().string(), metadata);
  }

  void add_meshes() {
    std::vector<io::NamedMesh> bodies = io::read_meshes(input_.file, reading_.unit_nm);
    for (io::NamedMesh& body : bodies) {
      io::WebSurface surface;
      surface.name = unique_name(page_, body.name.empty() ? input_.file.stem().string() : body.name);
      if (!body.material.empty()) surface.metadata["material"] = body.material;
      surface.metadata["file"] = input_.file.filename().string();
      if (reading_.tolerance_nm) {
        SimplifyOptions options;
        options.tolerance_nm = *reading_.tolerance_nm;
        SimplifySummary summary;
        body.mesh = simplify_mesh(body.mesh, options, summary);
        note(fmt::format("{} triangles instead of {}, at most {} apart", summary.triangles_after,
                         summary.triangles_before, format_length(summary.deviation.largest_nm())));
        surface.metadata["view.deviation_nm"] = format_exact(summary.deviation.largest_nm());
      }
      surface.shape = std::move(body.mesh);
      page_.surfaces.push_back(std::move(surface));
    }
  }

  void add_image() {
    io::WebImage picture = read_picture(input_, reading_);
    if (const Channel* heights = height_channel(picture.image, input_.channel)) {
      std::vector<io::WebScalar> scalars;
      for (const Channel& channel : picture.image.channels) {
        if (&channel == heights || channel.name == "valid") continue;
        io::WebScalar scalar{channel.name, channel.unit, channel.values.data()};
        for (float& value : scalar.values)
          if (!std::isfinite(value)) value = std::numeric_limits<float>::quiet_NaN();
        scalars.push_back(std::move(scalar));
      }
      HeightField field = io::to_height_field(picture.image, heights->name);
      add_field(std::move(field), input_.file.stem().string(), picture.image.metadata, std::move(scalars));
      const std::string name = heights->name;
      std::erase_if(picture.image.channels, [&](const Channel& channel) { return channel.unit == "nm"; });
      const bool pictures_left = std::any_of(picture.image.channels.begin(), picture.image.channels.end(),
                                             [](const Channel& channel) { return channel.name != "valid"; });
      if (!pictures_left) return;
    } else if (!input_.channel.empty()) {
      std::erase_if(picture.image.channels, [&](const Channel& channel) {
        return channel.name != input_.channel && channel.name != "valid";
      });
    }
    page_.images.push_back(std::move(picture));
  }

 private:
  void note(const std::string& text) const {
    if (!reading_.quiet) print_note(fmt::format("{}: {}", input_.file.string(), text));
  }

  static std::string ordinal(int number) {
    return number == 2 ? "second" : number == 3 ? "third" : fmt::format("{}th", number);
  }

  std::vector<float> thinned(const std::vector<float>& values, const HeightField& fine) const {
    std::vector<float> some;
    for (int y = 0; y < fine.z_nm.height(); y += reading_.step)
      for (int x = 0; x < fine.z_nm.width(); x += reading_.step)
        some.push_back(values[std::size_t(y) * std::size_t(fine.z_nm.width()) + std::size_t(x)]);
    return some;
  }

  const FileChannel& input_;
  const ViewReading& reading_;
  io::WebPage& page_;
};

}  // namespace

FileChannel parse_file_channel(const std::string& text) {
  if (is_file(text)) return {text, {}};
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon + 1 < text.size() && is_file(text.substr(0, colon)))
    return {text.substr(0, colon), text.substr(colon + 1)};
  throw FileError(text, "there is no such file", "Check the name; a channel is given as FILE:CHANNEL");
}

HeightField every_sample(const HeightField& field, int step) {
  HeightField some;
  const int width = (field.z_nm.width() - 1) / step + 1, height = (field.z_nm.height() - 1) / step + 1;
  if (width < 2 || height < 2)
    throw UsageError("--step", fmt::format("every {} samples nothing is left of {} x {}", step, field.z_nm.width(),
                                           field.z_nm.height()),
                     "Give a smaller number");
  some.pitch_x_nm = field.pitch_x_nm * step;
  some.pitch_y_nm = field.pitch_y_nm * step;
  some.origin_x_nm = field.origin_x_nm;
  some.origin_y_nm = field.origin_y_nm;
  some.z_nm = Grid<double>(width, height);
  if (!field.valid.empty()) some.valid = Grid<unsigned char>(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      some.z_nm(x, y) = field.z_nm(x * step, y * step);
      if (!field.valid.empty()) some.valid(x, y) = field.valid(x * step, y * step);
    }
  }
  return some;
}

io::WebImage read_view_image(const FileChannel& input, const ViewReading& reading) {
  return io::is_height_field_file(input.file) ? read_scan_channel(input, reading) : read_picture(input, reading);
}

std::string unique_name(const io::WebPage& page, const std::string& name) {
  std::string unique = name.empty() ? "surface" : name;
  for (int number = 2; std::any_of(page.surfaces.begin(), page.surfaces.end(),
                                   [&](const io::WebSurface& surface) { return surface.name == unique; });
       ++number)
    unique = fmt::format("{} {}", name.empty() ? "surface" : name, number);
  return unique;
}

void add_view_input(const FileChannel& input, const ViewReading& reading, io::WebPage& page) {
  Adder adder(input, reading, page);
  if (io::is_scene_file(input.file))
    throw UsageError(input.file.string(), "a scene is a recipe, not a surface",
                     "Simulate it with --channels z_nm and show the image that this makes");
  if (io::is_height_field_file(input.file)) return adder.add_scan();
  if (io::is_image_file(input.file)) return adder.add_image();
  if (!input.channel.empty())
    throw UsageError(input.file.string(), fmt::format("a mesh has no channel '{}'", input.channel),
                     "Name the file alone");
  adder.add_meshes();
}

}  // namespace surf::cli
