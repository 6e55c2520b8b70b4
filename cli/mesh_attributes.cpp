// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/io/surface_file.h"
#include "surf/mesh/vertex_curvature.h"
#include "surf/workflow/image_sampler.h"

namespace surf::cli {
namespace {

bool has(const Surface& surface, const std::string& name) {
  return std::ranges::any_of(surface.scalars,
                             [&](const VertexScalar& s) { return s.name == name; });
}

}  // namespace

void add_shape_scalars(SurfaceScene& scene, const Watch& watch) {
  for (Surface& surface : scene.surfaces) {
    if (!has(surface, "height")) {
      VertexScalar height{"height", "nm", {}};
      for (const Vec3& v : surface.mesh.vertices_nm)
        height.values.push_back(static_cast<float>(v.z));
      surface.scalars.insert(surface.scalars.begin(), std::move(height));
    }
    if (!has(surface, "curvature"))
      surface.scalars.insert(surface.scalars.begin() + 1,
                             {"curvature", "1/nm", mean_curvature(surface.mesh, 0, watch)});
  }
}

void add_image_scalar(const workflow::FileChannel& input, const workflow::GivenPitch& pitch,
                      SurfaceScene& scene) {
  const auto [picture, channel] = workflow::read_placed_picture(input, pitch);
  const workflow::ImageSampler sampler(picture.image, channel);
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::any_of(scene.surfaces,
                               [&](const Surface& surface) { return has(surface, name); });
  };
  std::string name = scalar_name(channel);
  if (is_taken(name)) name = scalar_name(channel + " of " + input.file.stem().string());
  const std::string base = name;
  for (int number = 2; is_taken(name); ++number) name = fmt::format("{}_{}", base, number);
  for (Surface& surface : scene.surfaces) {
    VertexScalar scalar{name, picture.image.find(channel)->unit, {}};
    if (scalar.unit.empty()) scalar.unit = std::string("1");
    for (const Vec3& v : surface.mesh.vertices_nm) {
      const float value = sampler.at(v.x, v.y);
      if (!std::isfinite(value))
        throw InvalidInput(
            input.file.string(),
            fmt::format("'{}' says nothing at ({:.6g}, {:.6g}) nm, where '{}' has a vertex",
                        channel, v.x, v.y, surface.name),
            fmt::format("Give a map without holes of all of the surface; this one is {}",
                        workflow::place_of(picture.image)));
      scalar.values.push_back(value);
    }
    surface.scalars.push_back(std::move(scalar));
  }
}

void add_drape(const workflow::FileChannel& input, const workflow::GivenPitch& pitch,
               SurfaceScene& scene) {
  const auto [picture, channel] = workflow::read_placed_picture(input, pitch);
  const Drape drape = io::make_drape(picture.image, channel);
  bool used = false;
  for (Surface& surface : scene.surfaces) {
    const auto lies_under = [&](const Vec3& v) {
      return workflow::covers(picture.image, v.x, v.y);
    };
    if (std::ranges::none_of(surface.mesh.vertices_nm, lies_under)) continue;
    surface.drape = drape;
    used = true;
  }
  if (!used)
    throw InvalidInput(
        input.file.string(),
        fmt::format("the picture, {}, lies over no surface", workflow::place_of(picture.image)),
        "Give one of the same place");
}

}  // namespace surf::cli
