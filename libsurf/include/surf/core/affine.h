// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace surf {

struct Point2 {
  double x = 0, y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

/// An affine map of the plane: x' = xx x + xy y + x0 and y' = yx x + yy y + y0, all in nm. A map
/// between images goes from SEM to AFM. Its six numbers are written in the order of the 2 x 3
/// matrix: xx xy x0 yx yy y0.
struct Affine {
  double xx = 1, xy = 0, x0 = 0;
  double yx = 0, yy = 1, y0 = 0;

  Point2 operator()(Point2 p) const { return {xx * p.x + xy * p.y + x0, yx * p.x + yy * p.y + y0}; }
  double determinant() const { return xx * yy - xy * yx; }
  friend bool operator==(const Affine&, const Affine&) = default;
};

/// The inverse map. Throws InvalidInput if the map has none: its determinant is 0 or a number is
/// not finite.
Affine inverse(const Affine& map);

/// The map that applies `inner` first, then `outer`.
Affine compose(const Affine& outer, const Affine& inner);

/// An affine map as a person describes it: a shear along x, then a scale along each axis, then a
/// rotation, then a shift. map = rotation * diag(scale_x, scale_y) * [1 shear; 0 1] + shift.
struct AffineParts {
  double rotation_rad = 0;          ///< counter-clockwise, in (-pi, pi]
  double scale_x = 1, scale_y = 1;  ///< scale_y < 0: mirrored
  double shear = 0;                 ///< tangent of the angle
  double shift_x_nm = 0, shift_y_nm = 0;
};
AffineParts parts_of(const Affine& map);
Affine make_affine(const AffineParts& parts);

}  // namespace surf
