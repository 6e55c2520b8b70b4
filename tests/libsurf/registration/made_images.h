// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "surf/core/affine.h"
#include "surf/core/placed_image.h"
#include "surf/core/random.h"

namespace surf::test {

/// Spots of many sizes, the same for the same seed, as a function of the place.
class Spots {
 public:
  explicit Spots(std::uint64_t seed, double half = 160) {
    RandomStream random(seed, 1, 1);
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    for (int i = 0; i < 260; ++i)
      spots_.push_back(
          {between(-half, half), between(-half, half), between(3, 9), between(-1, 1.5)});
  }
  double operator()(double x, double y) const {
    double sum = 0;
    for (const auto& [cx, cy, s, a] : spots_)
      sum += a * std::exp(-0.5 * ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (s * s));
    return sum;
  }

 private:
  struct Spot {
    double x, y, size, height;
  };
  std::vector<Spot> spots_;
};

using Scene = std::function<double(double, double)>;

/// What a microscope shows of the scene through the map, in pixels of `pitch` nm about (0, 0).
inline PlacedImage image_of(const Scene& scene, const Affine& map, int w, int h, double pitch,
                            double noise, std::uint64_t seed) {
  PlacedImage image{{pitch, pitch, -0.5 * (w - 1) * pitch, -0.5 * (h - 1) * pitch},
                    Grid<double>(w, h)};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      RandomStream random(seed, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x));
      double sum = -6;
      for (int i = 0; i < 12; ++i) sum += random.uniform();
      const Point2 p = map(image.place_nm(x, y));
      image.values(x, y) = 3 + scene(p.x, p.y) + noise * sum;
    }
  return image;
}

/// Root mean square of the distance, over the SEM's pixels of 1 nm that lie in an image of `half`
/// nm about the middle.
inline double error_px(const Affine& a, const Affine& b, int w, int h, double half) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < h; y += 3)
    for (int x = 0; x < w; x += 3) {
      const Point2 p{x - 0.5 * (w - 1), y - 0.5 * (h - 1)}, q = a(p), r = b(p);
      if (std::abs(q.x) > half || std::abs(q.y) > half) continue;
      sum += (q.x - r.x) * (q.x - r.x) + (q.y - r.y) * (q.y - r.y);
      ++count;
    }
  return count ? std::sqrt(sum / count) : 1e9;
}

/// Discs on a square lattice.
inline Scene lattice_of(double period) {
  return [period](double x, double y) {
    return 1 / (1 + std::exp(4 * (std::hypot(std::remainder(x, period), std::remainder(y, period)) -
                                  0.27 * period)));
  };
}

}  // namespace surf::test
