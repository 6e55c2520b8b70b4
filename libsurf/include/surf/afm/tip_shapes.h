// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/afm/tip.h"

namespace surf {

/// The sampling of a tip of a given shape; the apex is sample (width / 2, height / 2).
struct TipSampling {
  double pitch_x_nm = 1, pitch_y_nm = 1;  ///< > 0
  int width = 41, height = 41;            ///< >= 1
};

// Shapes describe the physical tip, apex down, by its height z above the apex. The functions return
// the structuring function, T(x, y) = -z(-x, -y). All throw InvalidInput for values out of range.

/// z = r^2 / (2 radius). radius_nm > 0.
Tip parabolic_tip(double radius_nm, const TipSampling& sampling);

/// A cone that ends in a sphere of radius_nm >= 0 without a kink. The angle between side and axis
/// is half_angle_rad in (0, pi/2).
Tip conical_tip(double radius_nm, double half_angle_rad, const TipSampling& sampling);

/// The part of a sphere of radius_nm > 0 on a stem that a scan can see: the lower half of the
/// sphere and, farther out, the stem if it widens. The stem is a cone of stem_half_angle_rad in [0,
/// pi/2) that leaves the sphere's upper half with stem_radius_nm in (0, radius). Half angle 0: a
/// cylinder, which a scan never sees.
Tip ball_tip(double radius_nm, double stem_radius_nm, double stem_half_angle_rad,
             const TipSampling& sampling);

struct PyramidShape {
  /// Angle of each face with the axis in (0, pi/2), counter-clockwise; at least 3. Outward normals
  /// are equally spaced in azimuth.
  std::vector<double> face_angles_rad;
  double rotation_rad = 0;  ///< azimuth of the first face's outward normal, from +x
  double radius_nm = 0;  ///< >= 0; rounds apex and edges as a sphere of this radius rolls over them
};
Tip pyramidal_tip(const PyramidShape& shape, const TipSampling& sampling);

/// A hemisphere, -infinity beyond its radius >= 0. It models the effect of a fixed distance between
/// tip and surface on an image. No larger than necessary for `max_width` x `max_height` samples.
Tip hemisphere_tip(double radius_nm, double pitch_x_nm, double pitch_y_nm, int max_width,
                   int max_height);

}  // namespace surf
