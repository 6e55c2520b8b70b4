// SPDX-License-Identifier: GPL-3.0-or-later
#include "laid_scalar.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "surf/workflow/image_sampler.h"

namespace surf::workflow {
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

constexpr double fits_as_well = 0.5;  // of the best surface's share

struct Extent {
  double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;

  void extend(double x, double y) {
    x0 = std::min(x0, x), x1 = std::max(x1, x);
    y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
  double area() const { return std::max(0.0, x1 - x0) * std::max(0.0, y1 - y0); }
};

Extent extent_of(const io::WebSurface& surface) {
  Extent e;
  for_each_place(surface, [&](double x, double y) { e.extend(x, y); });
  return e;
}

Extent extent_of(const Image& image) {
  Extent e;
  e.extend(image.origin_x_nm, image.origin_y_nm);
  e.extend(image.origin_x_nm + (image.width() - 1) * image.pitch_x_nm,
           image.origin_y_nm + (image.height() - 1) * image.pitch_y_nm);
  return e;
}

/// 1 for the same extent, 0 for extents apart.
double share(const Extent& a, const Extent& b) {
  const Extent both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1),
                    std::min(a.y1, b.y1)};
  const double all = a.area() + b.area() - both.area();
  return all > 0 ? both.area() / all : 0;
}

}  // namespace

bool lies_over(const Image& image, const io::WebSurface& surface) {
  bool found = false;
  for_each_place(surface, [&](double x, double y) { found = found || covers(image, x, y); });
  return found;
}

LaidScalar add_sampled_scalar(io::WebPage& page, const Image& image, const std::string& channel,
                              const std::string& name) {
  const ImageSampler sampler(image, channel);
  const Extent of_map = extent_of(image);
  std::vector<double> shares;
  for (const io::WebSurface& surface : page.surfaces)
    shares.push_back(share(extent_of(surface), of_map));
  const double best = shares.empty() ? 0 : *std::ranges::max_element(shares);
  LaidScalar laid;
  for (std::size_t i = 0; i < page.surfaces.size(); ++i) {
    io::WebSurface& surface = page.surfaces[i];
    io::WebScalar scalar{name, image.find(channel)->unit, {}};
    std::size_t here = 0;
    for_each_place(surface, [&](double x, double y) {
      scalar.values.push_back(sampler.at(x, y));
      here += std::isfinite(scalar.values.back());
    });
    if (here == 0) continue;
    if (shares[i] < fits_as_well * best) {
      laid.left_out.push_back(surface.name);
      continue;
    }
    surface.scalars.push_back(std::move(scalar));
    laid.values += here;
  }
  return laid;
}

}  // namespace surf::workflow
