// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace surf::workflow {
namespace {

constexpr double rounding = 1e-9;  // samples beyond the border that still count as on it

/// Gives each hole beside known samples their mean. Returns whether there was any.
bool grow(Grid<double>& z, Mask& known) {
  const int w = z.width(), h = z.height();
  std::vector<std::pair<std::size_t, double>> found;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (known(x, y)) continue;
      double sum = 0;
      int count = 0;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        const int u = x + dx, v = y + dy;
        if (u < 0 || v < 0 || u >= w || v >= h || !known(u, v)) continue;
        sum += z(u, v);
        ++count;
      }
      if (count > 0)
        found.emplace_back(
            static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x),
            sum / count);
    }
  for (const auto& [i, height] : found) {
    z.data()[i] = height;
    known.data()[i] = 1;
  }
  return !found.empty();
}

}  // namespace

HeightField with_holes_filled(const HeightField& field) {
  HeightField whole = field;
  if (field.valid.empty()) return whole;
  Mask known = field.valid;
  while (grow(whole.z_nm, known)) {
  }
  whole.valid = {};
  return whole;
}

SurfaceUnderSem surface_under_sem(const HeightField& afm_surface, const PlacedImage& sem,
                                  const Affine& sem_to_afm) {
  const HeightField whole = with_holes_filled(afm_surface);
  const int w = sem.values.width(), h = sem.values.height();
  const int columns = whole.z_nm.width(), rows = whole.z_nm.height();
  SurfaceUnderSem under;
  HeightField& surface = under.surface;
  surface.z_nm = Grid<double>(w, h);
  surface.placement() = sem.placement();
  under.known = Mask(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const Point2 p = sem_to_afm(sem.place_nm(x, y));
      const double u = (p.x - whole.origin_x_nm) / whole.pitch_x_nm,
                   v = (p.y - whole.origin_y_nm) / whole.pitch_y_nm;
      const bool inside = u >= -rounding && v >= -rounding && u <= columns - 1 + rounding &&
                          v <= rows - 1 + rounding;
      const double cu = std::clamp(u, 0.0, columns - 1.0), cv = std::clamp(v, 0.0, rows - 1.0);
      const int i = std::min(static_cast<int>(cu), columns - 2),
                j = std::min(static_cast<int>(cv), rows - 2);
      const double a = cu - i, b = cv - j;
      const auto z = [&](int s, int t) { return whole.z_nm(i + s, j + t); };
      surface.z_nm(x, y) =
          (1 - b) * ((1 - a) * z(0, 0) + a * z(1, 0)) + b * ((1 - a) * z(0, 1) + a * z(1, 1));
      const auto valid = [&](int s, int t) { return afm_surface.is_valid(i + s, j + t); };
      under.known(x, y) = inside && valid(0, 0) && valid(1, 0) && valid(0, 1) && valid(1, 1);
    }
  const auto& known = under.known.data();
  under.overlap =
      std::accumulate(known.begin(), known.end(), 0.0) / static_cast<double>(known.size());
  return under;
}

}  // namespace surf::workflow
