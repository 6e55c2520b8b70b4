// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// Options for `certainty_map` (docs/explanation/certainty.md).
struct CertaintyOptions {
  double noise_nm = 0;  ///< standard deviation of the image's noise, >= 0
  double sigmas = 3;    ///< bound of the noise, in standard deviations, > 0

  /// Half the side, in samples, of the largest square of possible contacts that counts as one
  /// place, in [0, 100]. An image pixel whose possible contacts need a larger square is ambiguous.
  /// -1: the half side of the tip's apex region within the tolerance, so that a flat surface is
  /// certain; without noise 0, which is the classical map.
  int neighbourhood = -1;

  /// Distance kept in a non-contact image (see `dilate_noncontact`), >= 0.
  double distance_nm = 0;
  int threads = 0;  ///< 0: one per hardware thread; the result does not depend on it
  Watch watch;
};

struct CertaintyMap {
  static constexpr unsigned char uncertain = 255;

  /// Per surface sample: `uncertain`, or half the side, in samples, of the smallest square of
  /// possible contacts in which this sample fits best. 0: the tip touched this sample and no other.
  Grid<unsigned char> level;

  HeightField surface;  ///< the eroded image that `level` belongs to
  /// Tolerance of possible contacts: 2 sigmas noise_nm, or the rounding error if that is larger.
  double tolerance_nm = 0;
  int neighbourhood = 0;         ///< the neighbourhood that was used
  std::size_t image_pixels = 0;  ///< valid image pixels, of three kinds:
  /// Pixels whose possible contacts lie within one neighbourhood, inside the image.
  std::size_t single = 0;
  /// Pixels whose possible contacts lie farther apart, or may lie outside the image.
  std::size_t ambiguous = 0;
  /// Pixels that no contact of this tip explains: noise, feedback error, or another tip.
  std::size_t unexplained = 0;
  std::size_t surface_samples = 0, certain = 0;
};

/// Shows where an eroded image is the surface, and not only an upper bound of it: Pingali and
/// Jain's certainty map (1992; thesis, C.2.1) with a tolerance. Let the noise be bounded by b =
/// sigmas noise_nm, and let r be the erosion. The true contact of an image pixel x1 is among the
/// samples x with r(x) + T(x1 - x) >= h(x1) - 2 b, and there r is within b of the surface. If all
/// these samples lie close together, the one that fits best is certain: r is within b of the
/// surface at that sample or at another one of them.
///
/// The tip may also have touched places outside the image, so r is continued there. Throws
/// InvalidInput as `erode` does, and for options out of range.
CertaintyMap certainty_map(const HeightField& image, const Tip& tip,
                           const CertaintyOptions& options = {});

/// Estimates the standard deviation of the pixel noise: 1.4826 / 6 of the median absolute value of
/// the mixed second differences of 3 x 3 samples (Immerkaer 1996 with a median). 0 if there are no
/// 3 x 3 valid samples. Too small for noise that is correlated from pixel to pixel; too large if
/// detail fills more than half the image.
double pixel_noise_nm(const HeightField& image);

}  // namespace surf
