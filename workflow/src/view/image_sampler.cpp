// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/image_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surf::workflow {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

struct Part {
  int dx, dy;
  double weight;
};

}  // namespace

bool covers(const Image& image, double x_nm, double y_nm) {
  const double x = (x_nm - image.origin_x_nm) / image.pitch_x_nm,
               y = (y_nm - image.origin_y_nm) / image.pitch_y_nm;
  return x >= -0.5 && x <= image.width() - 0.5 && y >= -0.5 && y <= image.height() - 0.5;
}

std::string place_of(const Image& image) {
  const double left = image.origin_x_nm - image.pitch_x_nm / 2,
               low = image.origin_y_nm - image.pitch_y_nm / 2;
  return fmt::format("x {:.6g} to {:.6g}, y {:.6g} to {:.6g} nm", left,
                     left + image.width() * image.pitch_x_nm, low,
                     low + image.height() * image.pitch_y_nm);
}

ImageSampler::ImageSampler(const Image& image, const std::string& channel)
    : image_(image), values_(image.find(channel)->values), valid_(image.find("valid")) {}

float ImageSampler::at(double x_nm, double y_nm) const {
  if (!covers(image_, x_nm, y_nm)) return nothing;
  const double x =
      std::clamp((x_nm - image_.origin_x_nm) / image_.pitch_x_nm, 0.0, double(values_.width() - 1));
  const double y = std::clamp((y_nm - image_.origin_y_nm) / image_.pitch_y_nm, 0.0,
                              double(values_.height() - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double fx = x - x0, fy = y - y0;
  double sum = 0;
  for (const auto& [dx, dy, weight] : {Part{0, 0, (1 - fx) * (1 - fy)}, Part{1, 0, fx * (1 - fy)},
                                       Part{0, 1, (1 - fx) * fy}, Part{1, 1, fx * fy}})
    if (weight > 0) sum += weight * pixel(x0 + dx, y0 + dy);
  return static_cast<float>(sum);
}

double ImageSampler::pixel(int x, int y) const {
  const float value = values_(x, y);
  return std::isfinite(value) && (!valid_ || valid_->values(x, y) != 0) ? value : double{nothing};
}

}  // namespace surf::workflow
