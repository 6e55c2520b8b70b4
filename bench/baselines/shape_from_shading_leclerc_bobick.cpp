// SPDX-License-Identifier: GPL-3.0-or-later
#include "shape_from_shading_leclerc_bobick.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "conjugate_gradients.h"
#include "image_pyramid.h"

namespace surf::bench {
namespace {

double mean(const std::vector<double>& z) {
  return std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size());
}

/// The sum to minimise and its gradient by heights in pixels.
double energy(const Grid<double>& image, const ReflectanceMap& reflectance, double lambda,
              const std::vector<double>& z, std::vector<double>& gradient) {
  const int w = image.width(), h = image.height();
  std::ranges::fill(gradient, 0);
  double sum = 0;
  const auto index = [w](int x, int y) { return static_cast<std::size_t>(y) * w + x; };
  const auto bend = [&](std::size_t before, std::size_t own, std::size_t after) {
    const double c = z[before] - 2 * z[own] + z[after];
    sum += lambda * c * c;
    gradient[before] += 2 * lambda * c;
    gradient[own] -= 4 * lambda * c;
    gradient[after] += 2 * lambda * c;
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int l = std::max(x - 1, 0), r = std::min(x + 1, w - 1), b = std::max(y - 1, 0),
                t = std::min(y + 1, h - 1);
      const std::size_t left = index(l, y), right = index(r, y), below = index(x, b),
                        above = index(x, t);
      const double per_x = 1.0 / (r - l), per_y = 1.0 / (t - b);
      const ReflectanceMap::Value v =
          reflectance.at((z[right] - z[left]) * per_x, (z[above] - z[below]) * per_y);
      const double off = v.r - image(x, y);
      sum += (1 - lambda) * off * off;
      const double by_p = 2 * (1 - lambda) * off * v.by_p * per_x,
                   by_q = 2 * (1 - lambda) * off * v.by_q * per_y;
      gradient[right] += by_p, gradient[left] -= by_p;
      gradient[above] += by_q, gradient[below] -= by_q;
      if (r - l == 2) bend(left, index(x, y), right);
      if (t - b == 2) bend(below, index(x, y), above);
    }
  return sum;
}

}  // namespace

Grid<double> shape_by_leclerc_bobick(const ShadedImage& image, const Grid<double>& start_nm,
                                     const LeclercBobickOptions& options,
                                     const HeightsSoFar& so_far) {
  const std::vector<Grid<double>> images = pyramid(image.relative, options.levels);
  Grid<double> z_nm = pyramid(start_nm, options.levels).front();
  const double constant_nm = mean(start_nm.data());
  const auto finest = [&](Grid<double> z) {
    for (const Grid<double>& finer : images)
      if (finer.width() > z.width()) z = doubled(z, finer.width(), finer.height());
    const double off = constant_nm - mean(z.data());
    for (double& v : z.data()) v += off;
    return z;
  };
  double pitch_nm = image.pitch_nm * static_cast<double>(1 << (images.size() - 1));
  double first = options.first_lambda, last = options.last_lambda;
  for (const Grid<double>& own : images) {
    z_nm = refined(std::move(z_nm), own.width(), own.height());
    std::vector<double> z = z_nm.data();
    for (double& v : z) v /= pitch_nm;
    for (double lambda = first; lambda > 0.99 * last; lambda /= std::numbers::sqrt2) {
      conjugate_gradients(
          [&](const std::vector<double>& at, std::vector<double>& gradient) {
            return energy(own, image.reflectance, lambda, at, gradient);
          },
          z, {options.iterations, options.tolerance});
      std::ranges::transform(z, z_nm.data().begin(), [&](double v) { return v * pitch_nm; });
      if (so_far) so_far(finest(z_nm));
    }
    pitch_nm /= 2;
    first /= 2, last /= 2;
  }
  return finest(std::move(z_nm));
}

}  // namespace surf::bench
