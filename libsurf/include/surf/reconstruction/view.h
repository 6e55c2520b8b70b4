// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/affine.h"
#include "surf/core/grid.h"
#include "surf/core/placed_image.h"
#include "surf/core/vec3.h"
#include "surf/reconstruction/image_data.h"

namespace surf {

/// The largest tilt of a view.
inline constexpr double largest_view_tilt_deg = 60;

/// From where a further SEM image sees the surface.
struct ViewPose {
  double tilt_deg = 0;     ///< of the beam from -z, 0 to 60
  double azimuth_deg = 0;  ///< toward which side it turns: 0 is +x, counter-clockwise from above
  /// From the image's frame to the plane through 0 perpendicular to the beam, nm: see `BeamAxes`.
  Affine to_plane;
};

/// Axes of what a tilted beam sees: x and y turned with it by the smallest rotation, and the
/// direction against the beam.
struct BeamAxes {
  Vec3 across, up, against;
};
BeamAxes beam_axes(double tilt_deg, double azimuth_deg);

/// The heights along the beam of what the pixels of an image at this pose see of a surface, and
/// those of `margin` more samples on every side: the surface that an upright beam would see in
/// place of the tilted one. Where a beam misses the surface its outermost heights go on, and the
/// sample is not valid. The surface has no holes and square samples. Throws InvalidInput.
HeightField heights_along_beam(const HeightField& surface, const PlacedImage& image,
                               const ViewPose& pose, int margin = 0, int threads = 0);

/// A further SEM image of the same surface, and how well its pose is known.
struct SemView {
  SemData sem;  ///< its map to the scan is not used: it follows from the pose
  ViewPose pose;
  /// Standard error of the tilt along x and y, and so, for small tilts, of tilt and azimuth.
  double tilt_error_deg = 0.5;
  /// Standard error of its pixel sizes, turn and shear against the first image's.
  double scale_error = 0.003;
  /// It was taken with the first image, by another detector: its pose is exact, and held.
  bool same_scan = false;
};

/// How a view agrees with the surface that was found.
struct ViewResult {
  ViewPose pose;              ///< fitted
  std::vector<double> gains;  ///< fitted
  double offset = 0;
  Grid<double> simulated;    ///< on the view's pixels
  Grid<double> residual;     ///< whitened, with the discrepancy taken off
  Grid<unsigned char> used;  ///< 1: the pixel contributes
  ResidualReport statistics;
  double discrepancy_share = 0;  ///< see Reconstruction
};

}  // namespace surf
