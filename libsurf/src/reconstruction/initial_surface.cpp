// SPDX-License-Identifier: GPL-3.0-or-later
#include "initial_surface.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/cubic_sample.h"
#include "surf/afm/morphology.h"

namespace surf::reconstruction {
namespace {

/// Fills each hole with the height of the nearest valid sample, by steps along the axes.
void fill_holes(HeightField& field) {
  if (field.valid.empty()) return;
  std::deque<std::pair<int, int>> rim;
  const int w = field.z_nm.width(), h = field.z_nm.height();
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (field.valid(x, y)) rim.emplace_back(x, y);
  while (!rim.empty()) {
    const auto [x, y] = rim.front();
    rim.pop_front();
    const int beside[4][2] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
    for (const auto& b : beside) {
      if (b[0] < 0 || b[1] < 0 || b[0] >= w || b[1] >= h || field.valid(b[0], b[1])) continue;
      field.z_nm(b[0], b[1]) = field.z_nm(x, y);
      field.valid(b[0], b[1]) = 1;
      rim.emplace_back(b[0], b[1]);
    }
  }
  field.valid = {};
}

}  // namespace

SurfaceFrame frame_of(const AfmData* afm, const SemData* sem, int margin) {
  if (sem) {
    const PlacedImage& i = sem->image;
    return {i.values.width() + 2 * margin, i.values.height() + 2 * margin, i.pitch_x_nm,
            i.origin_x_nm - margin * i.pitch_x_nm, i.origin_y_nm - margin * i.pitch_x_nm};
  }
  const HeightField& f = afm->image;
  const double pitch = std::min(f.pitch_x_nm, f.pitch_y_nm);
  const auto across = [&](int count, double own) {
    return static_cast<int>(std::floor((count - 1) * own / pitch + 1e-9)) + 1;
  };
  return {across(f.z_nm.width(), f.pitch_x_nm), across(f.z_nm.height(), f.pitch_y_nm), pitch,
          f.origin_x_nm, f.origin_y_nm};
}

HeightField eroded(const AfmData& afm, int threads) {
  MorphologyOptions options;
  options.threads = threads;
  HeightField field = erode(afm.image, afm.tip, options);
  fill_holes(field);
  return field;
}

Grid<double> on_frame(const HeightField& field, const SurfaceFrame& frame,
                      const Affine& surface_to_field) {
  Grid<double> out(frame.width, frame.height);
  const int w = field.z_nm.width(), h = field.z_nm.height();
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const Point2 p = surface_to_field(
          {frame.origin_x_nm + x * frame.pitch_nm, frame.origin_y_nm + y * frame.pitch_nm});
      const double u = std::clamp((p.x - field.origin_x_nm) / field.pitch_x_nm, 0.0, w - 1.0);
      const double v = std::clamp((p.y - field.origin_y_nm) / field.pitch_y_nm, 0.0, h - 1.0);
      out(x, y) = CubicSample(u, v, w, h).value(field.z_nm);
    }
  return out;
}

}  // namespace surf::reconstruction
