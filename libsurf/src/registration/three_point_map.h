// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/core/affine.h"
#include "surf/core/placed_image.h"

namespace surf {

/// An affine map, represented by three landmarks as in the thesis (7.2.1): the positions of the SEM
/// image's lower left, lower right and upper left corners in the AFM's frame, x0 y0 x1 y1 x2 y2.
/// All six numbers have the same scale. Lengths in the sources of the registration are SEM pixels,
/// relative to the centre of each image.
using ThreePointMap = std::array<double, 6>;

/// Weights of the three corners at a place of the SEM image; the weights add up to 1.
using Shares = std::array<double, 3>;

/// Means of products of shares over the relevant places. They convert differences of corners into a
/// root mean square distance.
using Moments = std::array<std::array<double, 3>, 3>;

class ThreePointFrame {
 public:
  ThreePointFrame(const PlacedImage& sem, const PlacedImage& afm);

  ThreePointMap three_points(const Affine& sem_to_afm) const;
  Affine affine(const ThreePointMap& corners) const;
  Shares shares(double column, double row) const {
    const double s = column / (width_ - 1), t = row / (height_ - 1);
    return {1 - s - t, s, t};
  }

  double pixel_nm() const { return pixel_nm_; }  ///< the geometric mean of both pitches
  Point2 sem_middle_nm() const { return sem_middle_; }
  Point2 afm_middle_nm() const { return afm_middle_; }

 private:
  int width_, height_;
  double pixel_nm_;
  Point2 sem_middle_, afm_middle_;
  std::array<Point2, 3> corners_nm_;
};

/// The position to which a place of the SEM image is mapped.
inline Point2 place(const ThreePointMap& c, const Shares& w) {
  return {w[0] * c[0] + w[1] * c[2] + w[2] * c[4], w[0] * c[1] + w[1] * c[3] + w[2] * c[5]};
}

/// The root mean square distance between the positions under two maps, over the places that the
/// moments were computed from.
double distance_px(const ThreePointMap& a, const ThreePointMap& b, const Moments& moments);

}  // namespace surf
