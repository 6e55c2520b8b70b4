// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/sample_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace surf {
namespace {

// A place this far beyond the border, in samples, counts as on the border.
constexpr double rounding = 1e-9;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double sample_image(const PlacedImage& image, Point2 place_nm) {
  const int w = image.values.width(), h = image.values.height();
  const double u = (place_nm.x - image.origin_x_nm) / image.pitch_x_nm;
  const double v = (place_nm.y - image.origin_y_nm) / image.pitch_y_nm;
  if (!(u >= -rounding && v >= -rounding && u <= w - 1 + rounding && v <= h - 1 + rounding))
    return nan;
  const int i = std::clamp(static_cast<int>(u), 0, std::max(w - 2, 0));
  const int j = std::clamp(static_cast<int>(v), 0, std::max(h - 2, 0));
  const double a = std::clamp(u - i, 0.0, 1.0), b = std::clamp(v - j, 0.0, 1.0);
  double sum = 0;
  for (const auto& [x, y, weight] : {std::tuple{i, j, (1 - a) * (1 - b)},
                                     {i + 1, j, a * (1 - b)},
                                     {i, j + 1, (1 - a) * b},
                                     {i + 1, j + 1, a * b}}) {
    if (weight == 0) continue;  // the sample may not exist
    if (!image.is_valid(x, y)) return nan;
    sum += weight * image.values(x, y);
  }
  return sum;
}

}  // namespace surf
