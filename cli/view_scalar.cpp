// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_scalar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace surf::cli {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

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

class Sampler {
 public:
  Sampler(const Image& image, const std::string& channel)
      : image_(image), values_(image.find(channel)->values), valid_(image.find("valid")) {}

  float at(double x_nm, double y_nm) const {
    const double x = (x_nm - image_.origin_x_nm) / image_.pitch_x_nm;
    const double y = (y_nm - image_.origin_y_nm) / image_.pitch_y_nm;
    const int right = values_.width() - 1, top = values_.height() - 1;
    // Pixels reach half a pitch beyond their centres.
    if (!(x >= -0.5 && x <= right + 0.5 && y >= -0.5 && y <= top + 0.5)) return nothing;
    const double cx = std::clamp(x, 0.0, double(right)), cy = std::clamp(y, 0.0, double(top));
    const int x0 = int(cx), y0 = int(cy);
    const double fx = cx - x0, fy = cy - y0;
    double sum = 0;
    for (const auto& [dx, dy, weight] : {Part{0, 0, (1 - fx) * (1 - fy)}, Part{1, 0, fx * (1 - fy)},
                                         Part{0, 1, (1 - fx) * fy}, Part{1, 1, fx * fy}})
      if (weight > 0) sum += weight * pixel(x0 + dx, y0 + dy);
    return static_cast<float>(sum);
  }

 private:
  struct Part {
    int dx, dy;
    double weight;
  };

  double pixel(int x, int y) const {
    const float value = values_(x, y);
    return std::isfinite(value) && (!valid_ || valid_->values(x, y) != 0) ? value : double{nothing};
  }

  const Image& image_;
  const Grid<float>& values_;
  const Channel* valid_;
};

}  // namespace

bool lies_over(const Image& image, const io::WebSurface& surface) {
  const double left = image.origin_x_nm - image.pitch_x_nm / 2, low = image.origin_y_nm - image.pitch_y_nm / 2;
  const double right = left + image.width() * image.pitch_x_nm, top = low + image.height() * image.pitch_y_nm;
  bool found = false;
  for_each_place(surface, [&](double x, double y) { found |= x >= left && x <= right && y >= low && y <= top; });
  return found;
}

std::size_t add_sampled_scalar(io::WebPage& page, const Image& image, const std::string& channel,
                               const std::string& name) {
  const Sampler sampler(image, channel);
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
