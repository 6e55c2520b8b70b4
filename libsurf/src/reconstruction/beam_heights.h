// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surf/reconstruction/view.h"
#include "surface_frame.h"

namespace surf::reconstruction {

/// A change of a view's pose. The plane's points are displaced, in the view's samples, as in
/// MapChange: 0 and 3 everywhere, 1, 4 and 2, 5 in addition at one reach of the view along x and y.
/// 6 and 7 turn the beam along x and y, in degrees.
inline constexpr int pose_numbers = 8, pose_tilt = 6;
using PoseChange = std::array<double, pose_numbers>;

/// The pose of a view whose samples are `view`, changed.
ViewPose changed(const ViewPose& pose, const SurfaceFrame& view, const PoseChange& by);

/// A surface as a tilted beam sees it: the height along the beam of what it meets first, on samples
/// of the plane perpendicular to it. Beyond the surface its outermost samples are repeated.
class BeamHeights {
 public:
  BeamHeights(const SurfaceFrame& surface, const Grid<double>& z_nm, const ViewPose& pose,
              const SurfaceFrame& view, int threads);

  const Grid<double>& heights() const { return heights_; }  ///< nm, along the beam
  /// The first-order change of the heights along the beam with that of the surface's. Where the
  /// beam grazes the surface it is limited.
  Grid<double> change(const Grid<double>& dz_nm) const;
  /// Its transpose: adds to `out`.
  void scatter(const Grid<double>& weights, Grid<double>& out) const;
  /// The same for a change of the pose.
  Grid<double> change(const PoseChange& pose) const;
  PoseChange by_pose(const Grid<double>& weights) const;
  /// Whether a sample of the view meets the surface, not what is repeated beyond it.
  bool meets(int x, int y) const;
  /// Where, in the surface's samples.
  Point2 hit(int x, int y) const { return hits_(x, y).at; }

 private:
  struct Hit {
    Point2 at;
    double rise = 0;                      // of the height along the beam, per rise of the surface
    double across = 0, up = 0;            // derivatives by the point of the plane
    double by_tilt_x = 0, by_tilt_y = 0;  // and by the beam's turn, per degree
  };
  /// Adds the changes of the height along the beam with each number of the pose.
  PoseChange numbers(int x, int y) const;

  SurfaceFrame surface_, view_;
  Grid<double> heights_;
  Grid<Hit> hits_;
};

}  // namespace surf::reconstruction
