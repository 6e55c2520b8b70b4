// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "surf/core/grid.h"
#include "surf/core/placed_image.h"
#include "surf/core/random.h"
#include "surf/sem/sem_noise.h"

namespace surf::test {

inline double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(random.uniform())) *
         std::cos(2 * std::numbers::pi * random.uniform());
}

/// Plateaus of six brightnesses between 40 and 140 with bright edges, slow shading, and a ripple
/// over the right quarter.
inline Grid<double> plateaus(int width, int height) {
  Grid<double> mean(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int column = 4 * x / width, row = 3 * y / height;
      double v = 40 + 20 * ((column + 2 * row) % 6);
      const double from_edge =
          std::fmin(std::fabs(std::remainder(4.0 * x / width, 1)) * width / 4,
                    std::fabs(std::remainder(3.0 * y / height, 1)) * height / 3);
      v += 60 * std::exp(-from_edge / 3) + 4 * std::sin(3.0 * x / width + 2.0 * y / height);
      if (column == 3) v += 12 * std::sin(2 * std::numbers::pi * (x + 0.3 * y) / 11);
      mean(x, y) = v;
    }
  return mean;
}

/// A draw of independent normal pixels.
inline Grid<double> draw(const Grid<double>& mean, const SemNoise& noise, std::uint64_t seed) {
  Grid<double> image = mean;
  RandomStream random(seed, 2, 0);
  for (double& v : image.data()) v += std::sqrt(noise.variance(v)) * normal(random);
  return image;
}

inline Grid<double> rounded(Grid<double> image, double least, double largest) {
  for (double& v : image.data()) v = std::fmin(std::fmax(std::round(v), least), largest);
  return image;
}

inline PlacedImage placed(Grid<double> values) {
  PlacedImage image;
  image.values = std::move(values);
  return image;
}

}  // namespace surf::test
