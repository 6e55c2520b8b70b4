// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "surf/core/height_field.h"
#include "surf/core/random.h"

// Surfaces that models of images are tested on.
namespace surf::test {

template <class Height>
HeightField sampled(int width, int height, double pitch_nm, const Height& z) {
  HeightField field{{pitch_nm, pitch_nm}, Grid<double>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) field.z_nm(x, y) = z(x, y);
  return field;
}

/// Bumps of all widths with white noise on them, about `relief_nm` high.
inline HeightField rough_field(int width, int height, double pitch_nm = 2, double relief_nm = 5,
                               std::uint64_t seed = 1) {
  RandomStream random(seed, 0, 0);
  double a[6], b[6], c[6];
  for (int i = 0; i < 6; ++i) {
    a[i] = 0.9 * random.uniform();
    b[i] = 0.9 * random.uniform();
    c[i] = 6 * random.uniform();
  }
  return sampled(width, height, pitch_nm, [&](int x, int y) {
    double z = 0.3 * random.uniform();
    for (int i = 0; i < 6; ++i) z += std::sin(a[i] * x + b[i] * y + c[i]);
    return relief_nm * z;
  });
}

/// Turned by 90 degrees: what lay along x lies along y.
template <class T>
Grid<T> turned(const Grid<T>& grid) {
  Grid<T> out(grid.height(), grid.width());
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) out(grid.height() - 1 - y, x) = grid(x, y);
  return out;
}

inline double largest_difference(const Grid<double>& a, const Grid<double>& b) {
  double most = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
    most = std::max(most, std::abs(a.data()[i] - b.data()[i]));
  return most;
}

}  // namespace surf::test
