// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_scalar.h"

#include <cmath>
#include <variant>

#include "image_sampler.h"

namespace surf::cli {
namespace {

template <class Use>
void for_each_place(const io::WebSurface& surface, const Use& use) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&surface.shape)) {
    for (const Vec3& vertex : mesh->vertices_nm) use(vertex.x, vertex.y);
    return;
  }
  const auto& field = std::get<HeightField>(surface.shape);
  for (int y = 0; y < field.z_nm.height(); ++y)
    for (int x = 0; x < field.z_nm.width(); ++x) use(field.x_nm(x), field.y_nm(y));
}

}  // namespace

bool lies_over(const Image& image, const io::WebSurface& surface) {
  bool found = false;
  for_each_place(surface, [&](double x, double y) { found = found || covers(image, x, y); });
  return found;
}

std::size_t add_sampled_scalar(io::WebPage& page, const Image& image, const std::string& channel,
                               const std::string& name) {
  const ImageSampler sampler(image, channel);
  std::size_t known = 0;
  for (io::WebSurface& surface : page.surfaces) {
    io::WebScalar scalar{name, image.find(channel)->unit, {}};
    std::size_t here = 0;
    for_each_place(surface, [&](double x, double y) {
      scalar.values.push_back(sampler.at(x, y));
      here += std::isfinite(scalar.values.back());
    });
    if (here > 0) surface.scalars.push_back(std::move(scalar));
    known += here;
  }
  return known;
}

}  // namespace surf::cli
