// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/affine.h"

namespace surf {

// Shapes as a share of their height, in [0, 1]: a binary pattern after a Gaussian blur of standard
// deviation `blur_nm`. The blur is exact for straight edges and rectangles; for other edges it
// neglects the curvature of the edge. Lengths are nm, angles degrees counter-clockwise from +x.

/// One piece of a stroke's centre line: straight or an arc.
struct StrokePiece {
  double length_nm;     ///< > 0
  double turn_deg = 0;  ///< even change of the heading along the piece
};

/// A line of constant width with round ends. Without pieces: a disc.
class Stroke {
 public:
  Stroke(Point2 start, double heading_deg, double width_nm, double blur_nm,
         const std::vector<StrokePiece>& pieces);
  double operator()(Point2 p) const;

 private:
  struct Piece {
    Point2 from;  // start of a straight piece; centre of an arc
    Point2
        along;  // unit vector: heading of a straight piece; from the centre to the middle of an arc
    double length_nm = 0;   // of a straight piece
    double radius_nm = 0;   // of an arc, else 0
    double half_angle = 0;  // of an arc, radians
    Point2 ends[2];
  };
  static double distance(const Piece& piece, Point2 p);

  std::vector<Piece> pieces_;
  double half_width_nm_, blur_nm_;
  Point2 start_;
  double reach_nm_;  // distance from the start beyond which the height is 0
};

/// A rotated rectangle about `centre`.
class Pad {
 public:
  Pad(Point2 centre, double width_nm, double depth_nm, double turn_deg, double blur_nm);
  double operator()(Point2 p) const;

 private:
  Point2 centre_, along_;
  double half_width_nm_, half_depth_nm_, blur_nm_;
};

/// A closed outline about `centre`: radius(angle) = radius_nm (1 + sum over k = 2, 3 ... of
/// amplitudes[k - 2] cos(k angle + phases[k - 2])), which must stay above four blurs.
class Island {
 public:
  Island(Point2 centre, double radius_nm, std::vector<double> amplitudes,
         std::vector<double> phases, double blur_nm);
  double operator()(Point2 p) const;

 private:
  Point2 centre_;
  double radius_nm_;
  std::vector<double> amplitudes_, phases_;
  double blur_nm_;
};

}  // namespace surf
