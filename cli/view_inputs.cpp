// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "terminal.h"

namespace surf::cli {
namespace {

const Channel* height_channel(const Image& image, const std::string& wanted) {
  if (!wanted.empty()) {
    const Channel* channel = image.find(wanted);
    return channel && channel->unit == "nm" ? channel : nullptr;
  }
  for (const Channel& channel : image.channels)
    if (channel.unit == "nm" && !channel.name.ends_with(".stderr")) return &channel;
  return nullptr;
}

class Adder {
 public:
  Adder(const FileChannel& input, const ViewReading& reading, io::WebPage& page)
      : input_(input), reading_(reading), page_(page) {}

  void add_field(HeightField field, const std::string& name,
                 std::map<std::string, std::string> metadata,
                 std::vector<io::WebScalar> scalars = {}) {
    io::WebSurface surface;
    surface.name = unique_name(page_, name);
    surface.metadata = std::move(metadata);
    if (reading_.every > 1) {
      const HeightField fine = std::move(field);
      field = every_sample(fine, reading_.every);
      note(fmt::format("every {} sample of {} x {}: {} x {} on the page", ordinal(reading_.every),
                       fine.z_nm.width(), fine.z_nm.height(), field.z_nm.width(),
                       field.z_nm.height()));
      for (io::WebScalar& scalar : scalars) scalar.values = thinned(scalar.values, fine);
      surface.metadata["view.every"] = std::to_string(reading_.every);
    }
    if (reading_.mesh_tolerance_nm) {
      auto [sheet, summary] = thin_height_field(
          field, {.tolerance_nm = *reading_.mesh_tolerance_nm, .watch = reading_.watch});
      surface.shape = std::move(sheet);
      note(fmt::format("{} triangles instead of {}, nowhere more than {} off",
                       summary.triangles_after, summary.triangles_before,
                       format_length(summary.deviation_nm)));
      surface.metadata["view.deviation_nm"] = format_exact(summary.deviation_nm);
      if (!scalars.empty())
        note(
            "with --mesh-tolerance its other channels are left out; --scalar lays one on what "
            "remains");
    } else {
      surface.shape = std::move(field);
      surface.scalars = std::move(scalars);
    }
    page_.surfaces.push_back(std::move(surface));
  }

  void add_scan() {
    io::HeightReadOptions options = reading_.heights;
    options.channel = input_.channel;
    if (!options.pitch_x_nm)
      options.pitch_x_nm = reading_.pitch.x_nm, options.pitch_y_nm = reading_.pitch.y_nm;
    const io::HeightFieldFile file = io::read_height_field(input_.file, options);
    for (const std::string& text : file.notes) note(text);
    std::map<std::string, std::string> metadata = file.metadata;
    metadata["file.format"] = file.format;
    if (!file.channel.empty()) metadata["file.channel"] = file.channel;
    add_field(file.field, input_.file.stem().string(), metadata);
  }

  void add_meshes() {
    SurfaceScene scene = io::read_surfaces(input_.file, reading_.unit);
    for (Surface& body : scene.surfaces) {
      if (body.drape) add_drape(*body.drape, body.name);
      io::WebSurface surface;
      surface.name = unique_name(page_, body.name);
      surface.metadata = scene.metadata;
      surface.metadata["file"] = input_.file.filename().string();
      if (reading_.mesh_tolerance_nm) {
        SimplifyOptions options;
        options.tolerance_nm = *reading_.mesh_tolerance_nm;
        options.watch = reading_.watch;
        auto [simple, summary] = simplify_mesh(merge_equal_vertices(body.mesh), options);
        body.mesh = std::move(simple);
        note(fmt::format("{} triangles instead of {}, at most {} apart", summary.triangles_after,
                         summary.triangles_before, format_length(summary.deviation.largest_nm())));
        if (!body.scalars.empty())
          note("with --mesh-tolerance its scalars are left out; --scalar lays one on what remains");
        body.scalars.clear();
        surface.metadata["view.deviation_nm"] = format_exact(summary.deviation.largest_nm());
      } else if (body.scalars.empty()) {
        body.mesh = merge_equal_vertices(body.mesh);
      }
      surface.shape = std::move(body.mesh);
      for (VertexScalar& scalar : body.scalars)
        if (scalar.name != "height")  // the page has its own
          surface.scalars.push_back({scalar.name, scalar.unit, std::move(scalar.values)});
      page_.surfaces.push_back(std::move(surface));
    }
  }

  void add_drape(const Drape& drape, const std::string& surface) {
    io::WebImage picture{fmt::format("picture on {}", surface), {}};
    Channel channel{drape.name.empty() ? "picture" : drape.name, "1",
                    Grid<float>(drape.grey.width(), drape.grey.height())};
    std::copy(drape.grey.data().begin(), drape.grey.data().end(), channel.values.data().begin());
    if (!page_.drape) page_.drape = {page_.images.size(), channel.name};
    picture.image.channels.push_back(std::move(channel));
    picture.image.placement() = drape.placement();
    page_.images.push_back(std::move(picture));
  }

  void add_image() {
    io::WebImage picture = read_plain_picture(input_, reading_.pitch);
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
      add_field(std::move(field), input_.file.stem().string(), picture.image.metadata,
                std::move(scalars));
      const std::string name = heights->name;
      std::erase_if(picture.image.channels,
                    [&](const Channel& channel) { return channel.unit == "nm"; });
      const bool pictures_left =
          std::any_of(picture.image.channels.begin(), picture.image.channels.end(),
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
    for (int y = 0; y < fine.z_nm.height(); y += reading_.every)
      for (int x = 0; x < fine.z_nm.width(); x += reading_.every)
        some.push_back(values[std::size_t(y) * std::size_t(fine.z_nm.width()) + std::size_t(x)]);
    return some;
  }

  const FileChannel& input_;
  const ViewReading& reading_;
  io::WebPage& page_;
};

}  // namespace

void describe(ParameterVisitor& visit, ViewParameters& p) {
  visit(p.mesh_tolerance_nm, {.name = "view.mesh_tolerance",
                              .help = "Fewer triangles, nowhere farther off than this",
                              .unit = Unit::nm,
                              .limits = above(0),
                              .otherwise = "all"});
  visit(p.every, {.name = "view.every",
                  .help = "Step of the samples of height fields that are shown: 2 is every "
                          "second one",
                  .limits = within(1, 1'000'000)});
}

HeightField every_sample(const HeightField& field, int step) {
  HeightField some;
  const int width = (field.z_nm.width() - 1) / step + 1,
            height = (field.z_nm.height() - 1) / step + 1;
  if (width < 2 || height < 2)
    throw UsageError("--every",
                     fmt::format("every {} samples nothing is left of {} x {}", step,
                                 field.z_nm.width(), field.z_nm.height()),
                     "Give a smaller number");
  some.pitch_x_nm = field.pitch_x_nm * step;
  some.pitch_y_nm = field.pitch_y_nm * step;
  some.origin_x_nm = field.origin_x_nm;
  some.origin_y_nm = field.origin_y_nm;
  some.z_nm = Grid<double>(width, height);
  if (!field.valid.empty()) some.valid = Mask(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      some.z_nm(x, y) = field.z_nm(x * step, y * step);
      if (!field.valid.empty()) some.valid(x, y) = field.valid(x * step, y * step);
    }
  }
  return some;
}

std::string unique_name(const io::WebPage& page, const std::string& name) {
  std::string unique = name.empty() ? "surface" : name;
  for (int number = 2;
       std::any_of(page.surfaces.begin(), page.surfaces.end(),
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
