// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/roughness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/samples.h"

namespace surf {

Roughness measure_roughness(const HeightField& field, const Mask& use) {
  require_field(field, use);
  Roughness r;
  r.tilt = fit_plane(field, use);
  const auto each = [&](const auto& visit) {
    for (int y = 0; y < field.z_nm.height(); ++y)
      for (int x = 0; x < field.z_nm.width(); ++x)
        if (is_used(field, use, x, y)) visit(x, y, field.z_nm(x, y));
  };
  // Relative to a height of the plane first, so that a large offset costs no digits.
  double sum = 0, lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  each([&](int, int, double z) {
    sum += z - r.tilt.height_nm;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
    ++r.samples;
  });
  const double n = static_cast<double>(r.samples);
  r.mean_nm = r.tilt.height_nm + sum / n;
  r.sz_nm = highest - lowest;
  double squares = 0, cubes = 0, fourths = 0, absolute = 0, levelled = 0;
  each([&](int x, int y, double z) {
    const double d = z - r.mean_nm, off = z - r.tilt.at(field.x_nm(x), field.y_nm(y));
    absolute += std::fabs(d);
    squares += d * d;
    cubes += d * d * d;
    fourths += d * d * d * d;
    levelled += off * off;
  });
  r.sa_nm = absolute / n;
  r.sq_nm = std::sqrt(squares / n);
  r.sq_levelled_nm = std::sqrt(levelled / n);
  if (r.sq_nm > 0) {
    r.ssk = cubes / n / std::pow(r.sq_nm, 3);
    r.sku = fourths / n / std::pow(r.sq_nm, 4);
  }
  return r;
}

}  // namespace surf
