// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/smooth_image.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace surf {
namespace {

std::vector<double> gaussian(double sigma) {
  std::vector<double> taps{1};
  if (sigma <= 0) return taps;
  const int reach = static_cast<int>(std::ceil(3.5 * sigma));
  taps.clear();
  for (int i = 0; i <= reach; ++i) taps.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
  return taps;
}

/// Convolves along one axis with symmetric taps. Samples outside the image do not contribute; the
/// blurred mask corrects for them.
Grid<double> convolved(const Grid<double>& in, const std::vector<double>& taps, bool along_x) {
  const int w = in.width(), h = in.height(), reach = static_cast<int>(taps.size()) - 1;
  if (reach == 0) return in;
  Grid<double> out(w, h);
  if (along_x) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        double sum = 0;
        for (int i = std::max(-reach, -x); i <= std::min(reach, w - 1 - x); ++i)
          sum += taps[static_cast<std::size_t>(std::abs(i))] * in(x + i, y);
        out(x, y) = sum;
      }
    return out;
  }
  for (int y = 0; y < h; ++y)
    for (int i = std::max(-reach, -y); i <= std::min(reach, h - 1 - y); ++i) {
      const double tap = taps[static_cast<std::size_t>(std::abs(i))];
      const double* const from = &in(0, y + i);
      double* const to = &out(0, y);
      for (int x = 0; x < w; ++x) to[x] += tap * from[x];
    }
  return out;
}

/// Replaces a row of samples by the coefficients of the spline through them, mirrored at its ends.
void to_coefficients(double* c, int n, std::ptrdiff_t stride) {
  const double pole = std::sqrt(3.0) - 2;
  if (n < 2) return;
  const auto at = [&](int i) -> double& { return c[i * stride]; };
  const int period = 2 * n - 2;
  double first = 0, power = 1;
  for (int i = 0; i < std::min(period, 60); ++i, power *= pole)
    first += power * at(i < n ? i : period - i);  // the remaining terms are below the last digit
  first /= 1 - std::pow(pole, period);
  const double gain = 6;
  at(0) = gain * first;
  for (int i = 1; i < n; ++i) at(i) = gain * at(i) + pole * at(i - 1);
  at(n - 1) = pole / (pole * pole - 1) * (at(n - 1) + pole * at(n - 2));
  for (int i = n - 2; i >= 0; --i) at(i) = pole * (at(i + 1) - at(i));
}

struct Weights {
  double value[4], slope[4];
};

Weights weights_of(double t) {
  const double r = 1 - t;
  return {{r * r * r / 6, 2.0 / 3 - 0.5 * t * t * (2 - t), 2.0 / 3 - 0.5 * r * r * (2 - r),
           t * t * t / 6},
          {-0.5 * r * r, t * (1.5 * t - 2), r * (2 - 1.5 * r), 0.5 * t * t}};
}

}  // namespace

Grid<double> blurred(const PlacedImage& image, double blur_x, double blur_y) {
  const int w = image.values.width(), h = image.values.height();
  double sum = 0, count = 0;
  Grid<double> values = image.values, weight(w, h, 1);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (image.is_valid(x, y)) sum += values(x, y), count += 1;
      else values(x, y) = weight(x, y) = 0;
    }
  // Relative to the mean, so that large offsets lose no digits.
  const double mean = count > 0 ? sum / count : 0;
  for (std::size_t i = 0; i < values.size(); ++i) values.data()[i] -= mean * weight.data()[i];
  const std::vector<double> across = gaussian(blur_x), up = gaussian(blur_y);
  values = convolved(convolved(values, across, true), up, false);
  weight = convolved(convolved(weight, across, true), up, false);
  for (std::size_t i = 0; i < values.size(); ++i)
    values.data()[i] = mean + (weight.data()[i] > 1e-12 ? values.data()[i] / weight.data()[i] : 0);
  return values;
}

SmoothImage::SmoothImage(const PlacedImage& image, double step_x, double step_y, double blur)
    : step_x_(step_x), step_y_(step_y), middle_x_(0.5 * (image.values.width() - 1)),
      middle_y_(0.5 * (image.values.height() - 1)), valid_(image.valid) {
  samples_ = blurred(image, blur / step_x, blur / step_y);
  const int w = samples_.width(), h = samples_.height();
  Grid<double> c = samples_;
  for (int y = 0; y < h; ++y) to_coefficients(&c(0, y), w, 1);
  for (int x = 0; x < w; ++x) to_coefficients(&c(x, 0), h, w);
  // Mirrors at the ends: the coefficient before the first equals the one after it.
  coefficients_ = Grid<double>(w + 2, h + 2);
  for (int y = -1; y <= h; ++y)
    for (int x = -1; x <= w; ++x)
      coefficients_(x + 1, y + 1) = c(x < 0    ? 1
                                      : x == w ? w - 2
                                               : x,
                                      y < 0    ? 1
                                      : y == h ? h - 2
                                               : y);
  if (valid_.empty()) return;
  safe_ = Mask(w, h, 0);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int right = std::min(x + 1, w - 1), above = std::min(y + 1, h - 1);
      safe_(x, y) =
          is_valid(x, y) && is_valid(right, y) && is_valid(x, above) && is_valid(right, above);
    }
}

SmoothImage::Value SmoothImage::at(double x, double y) const {
  const double last_x = coefficients_.width() - 3, last_y = coefficients_.height() - 3;
  const double wanted_u = column(x), wanted_v = row(y);
  const double u = std::clamp(wanted_u, 0.0, last_x), v = std::clamp(wanted_v, 0.0, last_y);
  const int i = std::min(static_cast<int>(u), coefficients_.width() - 4),
            j = std::min(static_cast<int>(v), coefficients_.height() - 4);
  const Weights across = weights_of(u - i), up = weights_of(v - j);
  Value sum;
  for (int k = 0; k < 4; ++k) {
    const double* const c = &coefficients_(i, j + k);
    const double value = across.value[0] * c[0] + across.value[1] * c[1] + across.value[2] * c[2] +
                         across.value[3] * c[3];
    const double slope = across.slope[0] * c[0] + across.slope[1] * c[1] + across.slope[2] * c[2] +
                         across.slope[3] * c[3];
    sum.value += up.value[k] * value;
    sum.dx += up.value[k] * slope;
    sum.dy += up.slope[k] * value;
  }
  sum.dx = u == wanted_u ? sum.dx / step_x_ : 0;
  sum.dy = v == wanted_v ? sum.dy / step_y_ : 0;
  return sum;
}

double SmoothImage::value(double x, double y) const {
  const double u = std::clamp(column(x), 0.0, coefficients_.width() - 3.0),
               v = std::clamp(row(y), 0.0, coefficients_.height() - 3.0);
  const int i = std::min(static_cast<int>(u), coefficients_.width() - 4),
            j = std::min(static_cast<int>(v), coefficients_.height() - 4);
  const Weights across = weights_of(u - i), up = weights_of(v - j);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const double* const c = &coefficients_(i, j + k);
    sum += up.value[k] * (across.value[0] * c[0] + across.value[1] * c[1] + across.value[2] * c[2] +
                          across.value[3] * c[3]);
  }
  return sum;
}

}  // namespace surf
