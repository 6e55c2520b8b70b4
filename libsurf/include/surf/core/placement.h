// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"

namespace surf {

/// The distances between neighbouring samples of a grid.
struct Pitch {
  double pitch_x_nm = 1;  ///< between columns, > 0
  double pitch_y_nm = 1;  ///< between rows, > 0

  const Pitch& pitch() const { return *this; }
  Pitch& pitch() { return *this; }
  friend bool operator==(const Pitch&, const Pitch&) = default;
};

/// The positions of the samples of a grid. Seen from above, x points right and y points up; z is
/// the height.
struct Placement : Pitch {
  double origin_x_nm = 0;  ///< centre of sample (0, 0), the lower-left sample
  double origin_y_nm = 0;

  double x_nm(double column) const { return origin_x_nm + column * pitch_x_nm; }
  double y_nm(double row) const { return origin_y_nm + row * pitch_y_nm; }
  Point2 place_nm(double column, double row) const { return {x_nm(column), y_nm(row)}; }

  /// Copy the placement of another grid with `a.placement() = b.placement()`.
  const Placement& placement() const { return *this; }
  Placement& placement() { return *this; }
  friend bool operator==(const Placement&, const Placement&) = default;
};

/// The largest magnitude of coordinates, heights and values of rasters, and of a pitch and its
/// inverse: fourth powers are still finite, so that no step makes NaN of them.
inline constexpr double largest_raster_number = 1e60;

/// Throws InvalidInput (naming `subject`) if a pitch is not positive or out of range.
void validate(const Pitch& pitch, const char* subject);

/// Throws InvalidInput (naming `subject`) if a pitch is not positive or out of range, or the origin
/// is.
void validate(const Placement& placement, const char* subject);

}  // namespace surf
