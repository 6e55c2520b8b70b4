// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// Options for dilation, erosion and their combinations (docs/explanation/morphology.md).
struct MorphologyOptions {
  /// Samples per pitch to which surface and tip are interpolated bilinearly before the operation;
  /// the result is sampled back. In [1, 32]; 1: no interpolation. It changes the results of
  /// operations in two steps (opening, closing, non-contact), at a cost that grows with its fourth
  /// power. Single operations give exactly the same result with any value, at no cost
  /// (docs/explanation/morphology.md).
  int upsample = 1;

  /// Heights are rounded to multiples of this quantum, > 0. After that all computations are exact,
  /// so that laws such as "opening twice is opening once" hold to the last bit between results with
  /// the same quantum. 0: the power of two at 2^-29 to 2^-28 of the sum of the surface's range and
  /// twice the tip's depth, or coarser if the heights themselves have fewer digits.
  double quantum_nm = 0;

  int threads = 0;  ///< 0: one per hardware thread; the result does not depend on it
  Watch watch;
};

/// The image that a tip makes of a surface, I(x) = max over u of S(x - u) + T(u) (thesis, Equation
/// C-7). It has the size of the surface. The surface is unknown in holes and beyond the border, and
/// only the known part contributes: the image is a lower bound there. Samples without any
/// contribution become holes. Throws InvalidInput for an invalid surface or tip, a surface without
/// valid heights, a tip of another pitch, and a quantum below 2^-29 of the range.
HeightField dilate(const HeightField& surface, const Tip& tip,
                   const MorphologyOptions& options = {});

/// The highest surface that is consistent with an image, R(x) = min over u of I(x + u) - T(u): an
/// upper bound of the true surface. The image is unknown in holes and beyond the border, and sets
/// no bound there.
HeightField erode(const HeightField& image, const Tip& tip, const MorphologyOptions& options = {});

/// Erosion, then dilation. The result is never above the image, and equals it where the tip can
/// touch the image from below. With `upsample` both steps are made on the fine grid.
HeightField opening(const HeightField& image, const Tip& tip,
                    const MorphologyOptions& options = {});

/// Dilation, then erosion. The result is never below the surface, and equals it where the tip can
/// touch the surface.
HeightField closing(const HeightField& surface, const Tip& tip,
                    const MorphologyOptions& options = {});

struct Dilation {
  HeightField image;

  /// The surface sample that touches the tip, in samples of the surface upsampled by `upsample` (f
  /// = upsample: its column f x is column x of the surface); -1 in holes. If several samples touch,
  /// the one is given whose tip sample lies in the row nearest the apex (of two rows the lower
  /// one), and then in the column nearest the apex (of two columns the left one).
  Grid<std::int32_t> contact_x, contact_y;
};

/// Like `dilate`, and also returns the contacts.
Dilation dilate_with_contacts(const HeightField& surface, const Tip& tip,
                              const MorphologyOptions& options = {});

/// The image of a tip that keeps the distance `distance_nm` >= 0 from the surface: dilation by a
/// hemisphere of that radius, which lifts a plane by the radius, and then by the tip (Pingali and
/// Jain 1992; thesis, C.2).
HeightField dilate_noncontact(const HeightField& surface, const Tip& tip, double distance_nm,
                              const MorphologyOptions& options = {});

/// The highest surface that is consistent with a non-contact image.
HeightField erode_noncontact(const HeightField& image, const Tip& tip, double distance_nm,
                             const MorphologyOptions& options = {});

}  // namespace surf
