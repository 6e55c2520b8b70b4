// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/view_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "laid_scalar.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/height_field_file.h"
#include "surf/io/image_file.h"
#include "surf/io/sim/scene_file.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/simplify_mesh.h"
#include "surf/mesh/thin_height_field.h"
#include "surf/workflow/image_sampler.h"

namespace surf::workflow {
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

std::string ordinal(int number) {
  return number == 2 ? "second" : number == 3 ? "third" : fmt::format("{}th", number);
}

std::vector<float> thinned(const std::vector<float>& values, const HeightField& fine, int every) {
  std::vector<float> some;
  for (int y = 0; y < fine.z_nm.height(); y += every)
    for (int x = 0; x < fine.z_nm.width(); x += every)
      some.push_back(values[std::size_t(y) * std::size_t(fine.z_nm.width()) + std::size_t(x)]);
  return some;
}

/// "name", "name 2" ...: what no surface of the page is called yet.
std::string unique_name(const io::WebPage& page, const std::string& name) {
  std::string unique = name.empty() ? "surface" : name;
  for (int number = 2;
       std::any_of(page.surfaces.begin(), page.surfaces.end(),
                   [&](const io::WebSurface& surface) { return surface.name == unique; });
       ++number)
    unique = fmt::format("{} {}", name.empty() ? "surface" : name, number);
  return unique;
}

}  // namespace

void describe(ParameterVisitor& visit, ViewParameters& p) {
  visit(p.mesh_tolerance_nm,
        {.name = "view.mesh_tolerance",
         .help = "Simplify to fewer triangles, moving the surface nowhere by more than this",
         .unit = Unit::nm,
         .limits = above(0),
         .otherwise = "all"});
  visit(
      p.every,
      {.name = "view.every",
       .help = "Step between the samples of height fields that are shown: 2 shows every second one",
       .limits = within(1, 1'000'000)});
}

HeightField every_sample(const HeightField& field, int step) {
  HeightField some;
  const int width = (field.z_nm.width() - 1) / step + 1,
            height = (field.z_nm.height() - 1) / step + 1;
  if (width < 2 || height < 2)
    throw UsageError("`view.every`",
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

ViewPage::ViewPage(ViewReading reading, Reporter reporter)
    : reading_(std::move(reading)), reporter_(std::move(reporter)) {}

void ViewPage::note(const std::string& text) const {
  reporter_.note(fmt::format("{}: {}", of_, text));
}

void ViewPage::add_field(HeightField field, const std::string& name, Metadata metadata,
                         std::vector<io::WebScalar> scalars) {
  io::WebSurface surface;
  surface.name = unique_name(page_, name);
  surface.metadata = std::move(metadata);
  if (reading_.every > 1) {
    const HeightField fine = std::move(field);
    field = every_sample(fine, reading_.every);
    note(fmt::format("every {} sample of {} x {}: {} x {} on the page", ordinal(reading_.every),
                     fine.z_nm.width(), fine.z_nm.height(), field.z_nm.width(),
                     field.z_nm.height()));
    for (io::WebScalar& scalar : scalars)
      scalar.values = thinned(scalar.values, fine, reading_.every);
    surface.metadata["view.every"] = std::to_string(reading_.every);
  }
  if (reading_.mesh_tolerance_nm) {
    auto [sheet, summary] = thin_height_field(
        field, {.tolerance_nm = *reading_.mesh_tolerance_nm, .watch = Watch{{}, reporter_.cancel}});
    surface.shape = std::move(sheet);
    note(fmt::format("{} triangles instead of {}, nowhere more than {} off",
                     summary.triangles_after, summary.triangles_before,
                     format_length(summary.deviation_nm)));
    surface.metadata["view.deviation_nm"] = format_exact(summary.deviation_nm);
    if (!scalars.empty())
      note(
          "with `view.mesh_tolerance` its other channels are left out; one given as a scalar is "
          "laid on what remains");
  } else {
    surface.shape = std::move(field);
    surface.scalars = std::move(scalars);
  }
  page_.surfaces.push_back(std::move(surface));
}

void ViewPage::add(HeightField field, const std::string& name, Metadata metadata) {
  of_ = name;
  add_field(std::move(field), name, std::move(metadata), {});
}

void ViewPage::add_body(Surface body, Metadata metadata) {
  io::WebSurface surface;
  surface.name = unique_name(page_, body.name);
  surface.metadata = std::move(metadata);
  if (reading_.mesh_tolerance_nm) {
    SimplifyOptions options;
    options.tolerance_nm = *reading_.mesh_tolerance_nm;
    options.watch = Watch{{}, reporter_.cancel};
    auto [simple, summary] = simplify_mesh(merge_equal_vertices(body.mesh), options);
    body.mesh = std::move(simple);
    note(fmt::format("{} triangles instead of {}, at most {} apart", summary.triangles_after,
                     summary.triangles_before, format_length(summary.deviation.largest_nm())));
    if (!body.scalars.empty())
      note(
          "with `view.mesh_tolerance` its scalars are left out; one given as a scalar is laid on "
          "what remains");
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

void ViewPage::add(TriangleMesh mesh, const std::string& name, Metadata metadata) {
  of_ = name;
  Surface body;
  body.name = name;
  body.mesh = std::move(mesh);
  add_body(std::move(body), std::move(metadata));
}

void ViewPage::add_drape_of(const Drape& drape, const std::string& surface) {
  io::WebImage picture{fmt::format("picture on {}", surface), {}};
  Channel channel{drape.name.empty() ? "picture" : drape.name, "1",
                  Grid<float>(drape.grey.width(), drape.grey.height())};
  std::copy(drape.grey.data().begin(), drape.grey.data().end(), channel.values.data().begin());
  if (!page_.drape) page_.drape = {page_.images.size(), channel.name};
  picture.image.channels.push_back(std::move(channel));
  picture.image.placement() = drape.placement();
  page_.images.push_back(std::move(picture));
}

void ViewPage::add_meshes(const FileChannel& input) {
  SurfaceScene scene = io::read_surfaces(input.file, reading_.unit);
  scene.metadata["file"] = input.file.filename().string();
  for (Surface& body : scene.surfaces) {
    if (body.drape) add_drape_of(*body.drape, body.name);
    add_body(std::move(body), scene.metadata);
  }
}

void ViewPage::add_picture(io::WebImage picture, const std::string& surface_name,
                           const std::string& wanted) {
  if (const Channel* heights = height_channel(picture.image, wanted)) {
    std::vector<io::WebScalar> scalars;
    for (const Channel& channel : picture.image.channels) {
      if (&channel == heights || channel.name == "valid") continue;
      io::WebScalar scalar{channel.name, channel.unit, channel.values.data()};
      for (float& value : scalar.values)
        if (!std::isfinite(value)) value = std::numeric_limits<float>::quiet_NaN();
      scalars.push_back(std::move(scalar));
    }
    HeightField field = io::to_height_field(picture.image, heights->name);
    add_field(std::move(field), surface_name, picture.image.metadata, std::move(scalars));
    std::erase_if(picture.image.channels,
                  [&](const Channel& channel) { return channel.unit == "nm"; });
    const bool pictures_left =
        std::any_of(picture.image.channels.begin(), picture.image.channels.end(),
                    [](const Channel& channel) { return channel.name != "valid"; });
    if (!pictures_left) return;
  } else if (!wanted.empty()) {
    std::erase_if(picture.image.channels, [&](const Channel& channel) {
      return channel.name != wanted && channel.name != "valid";
    });
  }
  page_.images.push_back(std::move(picture));
}

void ViewPage::add(Image image, const std::string& name, const std::string& channel) {
  of_ = name;
  add_picture({name, std::move(image)}, name, channel);
}

void ViewPage::add(const FileChannel& input) {
  of_ = input.file.string();
  if (io::is_scene_file(input.file))
    throw UsageError(of_, "a scene is a recipe, not a surface",
                     "Simulate it with the channel z_nm and show the image that this makes");
  const std::string stem = input.file.stem().string();
  if (io::is_height_field_file(input.file)) {
    io::HeightReadOptions options = reading_.heights;
    options.channel = input.channel;
    if (!options.pitch_x_nm)
      options.pitch_x_nm = reading_.pitch.x_nm, options.pitch_y_nm = reading_.pitch.y_nm;
    const io::HeightFieldFile file = io::read_height_field(input.file, options);
    for (const std::string& text : file.notes) note(text);
    Metadata metadata = file.metadata;
    metadata["file.format"] = file.format;
    if (!file.channel.empty()) metadata["file.channel"] = file.channel;
    return add_field(file.field, stem, metadata, {});
  }
  if (io::is_image_file(input.file))
    return add_picture(read_plain_picture(input, reading_.pitch), stem, input.channel);
  if (!input.channel.empty())
    throw UsageError(of_, fmt::format("a mesh has no channel '{}'", input.channel),
                     "Name the file alone");
  add_meshes(input);
}

void ViewPage::add_scalar(const FileChannel& input) {
  const auto [picture, channel] = read_placed_picture(input, reading_.pitch);
  of_ = input.file.string();
  add_scalar(picture.image, channel, input.file.stem().string());
}

void ViewPage::add_scalar(const Image& image, const std::string& channel, const std::string& of) {
  if (page_.surfaces.empty())
    throw UsageError("view", "there is no surface to lay a map on", "Give a scan or a mesh");
  std::string name = channel;
  const auto taken = [&](const std::string& wanted) {
    for (const io::WebSurface& surface : page_.surfaces)
      for (const io::WebScalar& scalar : surface.scalars)
        if (scalar.name == wanted) return true;
    return false;
  };
  if (taken(name)) name = fmt::format("{} of {}", channel, of);
  for (int number = 2; taken(name); ++number)
    name = fmt::format("{} of {} {}", channel, of, number);
  const LaidScalar laid = add_sampled_scalar(page_, image, channel, name);
  if (laid.values == 0)
    throw InvalidInput(of, fmt::format("'{}' has no value over any surface", channel),
                       "Give a map of the same place");
  for (const std::string& surface : laid.left_out)
    reporter_.note(
        fmt::format("{}: it is of another extent than '{}' and goes without it", surface, name));
  if (page_.scalar.empty()) page_.scalar = name;
}

void ViewPage::lay(io::WebImage picture, const std::string& channel) {
  if (page_.surfaces.empty())
    throw UsageError("view", "there is no surface to lay a picture on", "Give a scan or a mesh");
  if (std::ranges::none_of(page_.surfaces, [&](const io::WebSurface& surface) {
        return lies_over(picture.image, surface);
      }))
    throw InvalidInput(
        of_, fmt::format("the picture, {}, lies over no surface", place_of(picture.image)),
        "Give it as an image of its own to see it beside them");
  const auto same = std::ranges::find_if(page_.images, [&](const io::WebImage& image) {
    return image.name == picture.name && image.has_scale && image.image.find(channel);
  });
  page_.drape = {static_cast<std::size_t>(same - page_.images.begin()), channel};
  if (same == page_.images.end()) page_.images.push_back(std::move(picture));
}

void ViewPage::drape(const FileChannel& input) {
  auto [picture, channel] = read_placed_picture(input, reading_.pitch);
  of_ = input.file.string();
  lay(std::move(picture), channel);
}

void ViewPage::drape(Image image, const std::string& channel, const std::string& name) {
  of_ = name;
  lay({name, std::move(image)}, channel);
}

}  // namespace surf::workflow
