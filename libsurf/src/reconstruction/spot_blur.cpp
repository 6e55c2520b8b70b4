// SPDX-License-Identifier: GPL-3.0-or-later
#include "spot_blur.h"

#include <algorithm>

namespace surf::reconstruction {
namespace {

constexpr int passes = 4;

/// to = image + a (second difference along an axis), or the second difference alone.
Grid<double> pass(const Grid<double>& image, double a, bool along_x, bool difference_alone) {
  const int w = image.width(), h = image.height();
  Grid<double> out(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double here = image(x, y);
      const double before = along_x ? image(std::max(x - 1, 0), y) : image(x, std::max(y - 1, 0));
      const double after =
          along_x ? image(std::min(x + 1, w - 1), y) : image(x, std::min(y + 1, h - 1));
      const double difference = before - 2 * here + after;
      out(x, y) = difference_alone ? difference : here + a * difference;
    }
  return out;
}

Grid<double> passed(Grid<double> image, double a, bool along_x, int times) {
  for (int k = 0; k < times; ++k) image = pass(image, a, along_x, false);
  return image;
}

double weight_of(double variance_px2) { return variance_px2 / (2 * passes); }

}  // namespace

Grid<double> blurred(const Grid<double>& image, double variance_px2) {
  if (variance_px2 == 0) return image;
  const double a = weight_of(variance_px2);
  return passed(passed(image, a, true, passes), a, false, passes);
}

Grid<double> change_of_blur(const Grid<double>& image, double variance_px2) {
  // Passes commute, so that one of them is replaced by its difference, once along each axis.
  const double a = weight_of(variance_px2);
  const bool sharp = variance_px2 == 0;
  const auto rest = [&](Grid<double> of, bool along_x) {
    if (sharp) return of;
    return passed(passed(std::move(of), a, along_x, passes - 1), a, !along_x, passes);
  };
  Grid<double> out = rest(pass(image, a, true, true), true);
  const Grid<double> across = rest(pass(image, a, false, true), false);
  for (std::size_t i = 0; i < out.size(); ++i)
    out.data()[i] = passes * (out.data()[i] + across.data()[i]) * weight_of(1);
  return out;
}

}  // namespace surf::reconstruction
