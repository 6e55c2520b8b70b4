// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/afm/tip.h"

namespace surf {

/// Where a tip of a given shape is sampled; the apex is sample (width / 2, height / 2).
struct TipSampling {
  double pitch_x_nm = 1, pitch_y_nm = 1;  ///< > 0
  int width = 41, height = 41;            ///< >= 1
};

// Shapes are of the physical tip, apex down, at height z above the apex. What is returned is their
// structuring function, T(x, y) = -z(-x, -y). All throw InvalidInput for what is out of range.

/// z = r^2 / (2 radius). radius_nm > 0.
Tip parabolic_tip(double radius_nm, const TipSampling& sampling);

/// A cone that a sphere of radius_nm >= 0 ends without a kink. Its side is half_angle_rad in (0,
/// pi/2) from the axis.
Tip conical_tip(double radius_nm, double half_angle_rad, const TipSampling& sampling);

/// The part that a scan can see of a sphere of radius_nm > 0 on a stem: its lower half, and farther
/// out the stem where that widens, a cone of stem_half_angle_rad in [0, pi/2) that leaves the
/// sphere's upper half with stem_radius_nm in (0, radius). 0: a cylinder, which is never seen.
Tip ball_tip(double radius_nm, double stem_radius_nm, double stem_half_angle_rad,
             const TipSampling& sampling);

struct PyramidShape {
  /// Angle of each face with the axis in (0, pi/2), counter-clockwise; at least 3. Outward normals
  /// are equally spaced in azimuth.
  std::vector<double> face_angles_rad;
  double rotation_rad = 0;  ///< azimuth of the first face's outward normal, from +x
  double radius_nm = 0;     ///< >= 0; apex and edges are rounded as a sphere of this radius rolls
};
Tip pyramidal_tip(const PyramidShape& shape, const TipSampling& sampling);

/// A hemisphere, -infinity beyond its radius >= 0: what a fixed distance between tip and surface
/// does to an image. No larger than can meet `max_width` x `max_height` samples.
Tip hemisphere_tip(double radius_nm, double pitch_x_nm, double pitch_y_nm, int max_width,
                   int max_height);

}  // namespace surf
