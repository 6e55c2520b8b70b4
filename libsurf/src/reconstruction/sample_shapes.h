// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/affine.h"

namespace surf {

// Shapes as a share of their height, in [0, 1]: what a Gaussian blur of standard deviation
// `blur_nm` makes of a binary pattern, exactly for straight edges and rectangles, up to the
// curvature of an edge otherwise. Lengths are nm, angles degrees counter-clockwise from +x.

/// One piece of a stroke's middle line: straight, or an arc.
struct StrokePiece {
  double length_nm;     ///< > 0
  double turn_deg = 0;  ///< by which the heading changes evenly along it
};

/// A line of even width with round ends. Without pieces: a disc.
class Stroke {
 public:
  Stroke(Point2 start, double heading_deg, double width_nm, double blur_nm,
         const std::vector<StrokePiece>& pieces);
  double operator()(Point2 p) const;

 private:
  struct Piece {
    Point2 from;            // where it begins; of an arc its centre
    Point2 along;           // unit vector: the heading; of an arc from its centre to its middle
    double length_nm = 0;   // of a straight piece
    double radius_nm = 0;   // of an arc, else 0
    double half_angle = 0;  // of an arc, radians
    Point2 ends[2];
  };
  static double distance(const Piece& piece, Point2 p);

  std::vector<Piece> pieces_;
  double half_width_nm_, blur_nm_;
  Point2 start_;
  double reach_nm_;  // from there; 0 beyond
};

/// A rectangle about `centre`, turned.
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
