// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/random.h"
#include "surf/core/vec3.h"
#include "surf/mc/geometry/beam.h"

namespace surf::mc {

/// Where primaries start and where to: above everything, on the beam's line through the pixel.
class Gun {
 public:
  struct Start {
    Vec3 position, direction;
  };

  /// `top_nm`: the highest surface. Throws UsageError where beams of the scan would come from below
  /// it or from the side: a working distance too short, a tilt too steep for the cone.
  Gun(const Beam& beam, const Scan& scan, double top_nm);

  /// A primary of the pixel, somewhere in spot and cone.
  Start primary(int column, int row, RandomStream& random) const;

  /// The middle of a pixel's beam.
  Start middle(int column, int row) const;

 private:
  Start through(const Vec3& focus, const Vec3& direction) const;
  Vec3 in_plane(double u, double v) const { return center_ + across_ * u + up_ * v; }
  Vec3 pixel(int column, int row) const;
  Vec3 axis_at(const Vec3& in_plane) const;

  Scan scan_;
  Vec3 center_;
  Vec3 direction_;    // of the beam in the middle of the scan
  Vec3 across_, up_;  // the scan's axes
  double spot_nm_;
  double tan_convergence_;
  double focus_nm_;
  double working_distance_nm_;
  double start_nm_;  // z where electrons start
};

}  // namespace surf::mc
