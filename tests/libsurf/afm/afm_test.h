// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/random.h"

namespace surf::test {

inline constexpr double none = -std::numeric_limits<double>::infinity();

/// Multiples of `step` in [-depth, 0].
inline double random_height(RandomStream& random, double depth, double step) {
  return -step * std::floor(random.uniform() * (depth / step + 1));
}

/// Standard normal (Box and Muller).
inline double random_normal(RandomStream& random) {
  const double r = std::sqrt(-2 * std::log(random.uniform()));
  return r * std::cos(2 * std::numbers::pi * random.uniform());
}

/// Rough, of multiples of `step`; a share `holes` of the samples is invalid.
inline HeightField random_field(std::uint64_t seed, int width, int height, double step,
                                double holes = 0) {
  RandomStream random(seed, 1, 0);
  HeightField field{{1.5, 2, 10, -20}, Grid<double>(width, height)};
  if (holes > 0) field.valid = Mask(width, height, 1);
  for (std::size_t i = 0; i < field.z_nm.size(); ++i) {
    field.z_nm.data()[i] = 7 + random_height(random, 10, step);
    if (holes > 0 && random.uniform() < holes) {
      field.valid.data()[i] = 0;
      field.z_nm.data()[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return field;
}

/// Asymmetric: not square, its apex off the middle, with samples it does not have.
inline Tip random_tip(std::uint64_t seed, int width, int height, double step,
                      double missing = 0.1) {
  RandomStream random(seed, 2, 0);
  Tip tip{{1.5, 2}, Grid<double>(width, height), width / 3, 2 * height / 3};
  for (double& z : tip.z_nm.data())
    z = random.uniform() < missing ? none : random_height(random, 6, step);
  tip.z_nm(tip.apex_x, tip.apex_y) = 0;
  return tip;
}

/// The height, -infinity in holes and outside.
inline double at(const HeightField& f, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < f.z_nm.width() && y < f.z_nm.height();
  return inside && f.is_valid(x, y) ? f.z_nm(x, y) : none;
}

/// The definition of dilation, word by word; -infinity where nothing known contributes.
inline Grid<double> naive_dilation(const HeightField& s, const Tip& t) {
  Grid<double> out(s.z_nm.width(), s.z_nm.height(), none);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      for (int j = 0; j < t.z_nm.height(); ++j)
        for (int i = 0; i < t.z_nm.width(); ++i) {
          const double z = at(s, x - (i - t.apex_x), y - (j - t.apex_y));
          if (z != none) out(x, y) = std::max(out(x, y), z + t.z_nm(i, j));
        }
  return out;
}

/// The definition of erosion; +infinity where nothing known bounds it.
inline Grid<double> naive_erosion(const HeightField& image, const Tip& t) {
  Grid<double> out(image.z_nm.width(), image.z_nm.height(), -none);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      for (int j = 0; j < t.z_nm.height(); ++j)
        for (int i = 0; i < t.z_nm.width(); ++i) {
          const double z = at(image, x + (i - t.apex_x), y + (j - t.apex_y));
          if (z != none) out(x, y) = std::min(out(x, y), z - t.z_nm(i, j));
        }
  return out;
}

}  // namespace surf::test
