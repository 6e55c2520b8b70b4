// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/vec3.h"

namespace surf {
class ParameterVisitor;
}

namespace surf::mc {

/// The electron probe: monochromatic, Gaussian across at its focus, filling a cone evenly. Lengths:
/// at most `largest_length_nm`.
struct Beam {
  double energy_ev = 1000;  ///< 100 to 30000
  double tilt_deg = 0;      ///< angle of the beam from -z, 0 <= tilt < 90
  double azimuth_deg =
      0;  ///< toward which side it turns: 0 is +x, counter-clockwise from above; within ten turns
  double spot_nm = 0;  ///< standard deviation of the Gaussian spot along each axis; 0: a point
  double convergence_deg = 0;  ///< half angle of the cone; 0: parallel
  double focus_nm = 0;  ///< how far above the scan plane, along the beam, the cone has its tip
  /// Distance from the scan plane's centre to the point that all pixels' beams come from, > 0:
  /// perspective. 0: the beams are parallel, the point is infinitely far.
  double working_distance_nm = 0;
};

/// Unit vector along which the beam travels in the middle of the scan:
/// (sin t cos a, sin t sin a, -cos t).
Vec3 direction(const Beam& beam);

/// Which points the beam visits: a grid in the plane through the region's centre perpendicular to
/// the beam. For an untilted beam it is the region itself.
struct Scan {
  int width = 256;  ///< pixels, >= 1; width * height <= max_pixels
  int height = 256;
  double pixel_x_nm = 1;  ///< > 0
  double pixel_y_nm = 1;
  double center_x_nm = 0;  ///< centre of the region in the specimen frame
  double center_y_nm = 0;
  double center_z_nm = 0;  ///< matters for a tilted beam only
};

inline constexpr std::int64_t max_pixels = std::int64_t{1} << 28;

void describe(ParameterVisitor& visit, Beam& beam);
void describe(ParameterVisitor& visit, Scan& scan);

/// Throws UsageError naming the field.
void validate(const Beam& beam);
void validate(const Scan& scan);

}  // namespace surf::mc
