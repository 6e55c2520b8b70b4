// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/three_point_map.h"

#include <algorithm>
#include <cmath>

namespace surf {
namespace {

Point2 middle(const PlacedImage& image) {
  return image.place_nm(0.5 * (image.values.width() - 1), 0.5 * (image.values.height() - 1));
}

}  // namespace

ThreePointFrame::ThreePointFrame(const PlacedImage& sem, const PlacedImage& afm)
    : width_(sem.values.width()), height_(sem.values.height()),
      pixel_nm_(std::sqrt(sem.pitch_x_nm * sem.pitch_y_nm)), sem_middle_(middle(sem)),
      afm_middle_(middle(afm)), corners_nm_{sem.place_nm(0, 0), sem.place_nm(width_ - 1, 0),
                                            sem.place_nm(0, height_ - 1)} {}

ThreePointMap ThreePointFrame::three_points(const Affine& m) const {
  ThreePointMap c{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 p = m(corners_nm_[i]);
    c[2 * i] = (p.x - afm_middle_.x) / pixel_nm_;
    c[2 * i + 1] = (p.y - afm_middle_.y) / pixel_nm_;
  }
  return c;
}

Affine ThreePointFrame::affine(const ThreePointMap& c) const {
  const double width_nm = corners_nm_[1].x - corners_nm_[0].x,
               height_nm = corners_nm_[2].y - corners_nm_[0].y;
  Affine m;
  m.xx = (c[2] - c[0]) * pixel_nm_ / width_nm;
  m.yx = (c[3] - c[1]) * pixel_nm_ / width_nm;
  m.xy = (c[4] - c[0]) * pixel_nm_ / height_nm;
  m.yy = (c[5] - c[1]) * pixel_nm_ / height_nm;
  m.x0 = c[0] * pixel_nm_ + afm_middle_.x - m.xx * corners_nm_[0].x - m.xy * corners_nm_[0].y;
  m.y0 = c[1] * pixel_nm_ + afm_middle_.y - m.yx * corners_nm_[0].x - m.yy * corners_nm_[0].y;
  return m;
}

double distance_px(const ThreePointMap& a, const ThreePointMap& b, const Moments& moments) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum += moments[i][j] * ((a[2 * i] - b[2 * i]) * (a[2 * j] - b[2 * j]) +
                              (a[2 * i + 1] - b[2 * i + 1]) * (a[2 * j + 1] - b[2 * j + 1]));
  return std::sqrt(std::max(0.0, sum));
}

}  // namespace surf
