// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// How dilation, erosion and what is made of them are computed (docs/methods/morphology.md).
struct MorphologyOptions {
  /// Surface and tip are interpolated bilinearly to this many samples per pitch, and the result is
  /// sampled back. In [1, 32]; 1: as they are. It changes what is made of two operations (opening,
  /// closing, non-contact), at a cost that grows with its fourth power; a single one gives exactly
  /// the same at the samples, at no cost (docs/methods/morphology.md).
  int upsample = 1;

  /// Heights are rounded to multiples of it, > 0; then all is exact, so that laws such as "opening
  /// twice is opening once" hold to the last bit between results made with the same quantum. 0: the
  /// power of two at 2^-29 to 2^-28 of the surface's range and twice the tip's depth, or coarser
  /// where the heights themselves have no more digits.
  double quantum_nm = 0;

  int threads = 0;  ///< 0: one per hardware thread; the result does not depend on it
  Watch watch;
};

/// The image that a tip makes of a surface, I(x) = max over u of S(x - u) + T(u) (thesis, Equation
/// C-7). As large as the surface. Beyond the border and in holes the surface is unknown and takes
/// no part: the image is what the known part alone makes, a lower bound. Holes where nothing known
/// contributes. Throws InvalidInput for an invalid surface or tip, none valid, another pitch, or a
/// quantum that does not go into 2^29 of the range.
HeightField dilate(const HeightField& surface, const Tip& tip,
                   const MorphologyOptions& options = {});

/// The highest surface that agrees with an image, R(x) = min over u of I(x + u) - T(u): an upper
/// bound of the true one. Beyond the border and in holes the image is unknown and bounds nothing.
HeightField erode(const HeightField& image, const Tip& tip, const MorphologyOptions& options = {});

/// Erosion, then dilation: never above the image, and equal to it where the tip can touch it from
/// below. With `upsample` both are made on the fine grid.
HeightField opening(const HeightField& image, const Tip& tip,
                    const MorphologyOptions& options = {});

/// Dilation, then erosion: never below the surface, and equal to it where the tip can touch it.
HeightField closing(const HeightField& surface, const Tip& tip,
                    const MorphologyOptions& options = {});

struct Dilation {
  HeightField image;

  /// The surface sample that holds the tip, in samples of the surface upsampled by `upsample`
  /// (column f x of it is column x of the surface); -1 in holes. Of several the one whose tip
  /// sample lies in the row nearest the apex, of two rows the lower one; then in the column nearest
  /// it, of two the left one.
  Grid<std::int32_t> contact_x, contact_y;
};

/// As `dilate`, with what touched.
Dilation dilate_with_contacts(const HeightField& surface, const Tip& tip,
                              const MorphologyOptions& options = {});

/// The image of a tip that stays `distance_nm` >= 0 away from the surface: dilation by a hemisphere
/// of that radius, which lifts a plane by it, and then by the tip (Pingali and Jain 1992; thesis,
/// C.2).
HeightField dilate_noncontact(const HeightField& surface, const Tip& tip, double distance_nm,
                              const MorphologyOptions& options = {});

/// The highest surface that agrees with such an image.
HeightField erode_noncontact(const HeightField& image, const Tip& tip, double distance_nm,
                             const MorphologyOptions& options = {});

}  // namespace surf
