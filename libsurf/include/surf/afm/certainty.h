// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/afm/tip.h"
#include "surf/core/height_field.h"
#include "surf/core/progress.h"

namespace surf {

/// Where an eroded image is the surface, and not only an upper bound of it
/// (docs/methods/certainty.md).
struct CertaintyOptions {
  double noise_nm = 0;  ///< standard deviation of the image's noise, >= 0
  double sigmas = 3;    ///< the noise is taken to be within so many standard deviations, > 0

  /// Contacts that agree with an image pixel may be so many samples from the middle of the square
  /// that holds them all, in [0, 100]; more leave the pixel ambiguous. -1: as many as the tip's own
  /// apex has within the tolerance, so that a plain is certain; without noise 0, which is the
  /// classical map.
  int neighbourhood = -1;

  double distance_nm =
      0;            ///< >= 0; of a non-contact image, the distance kept (see dilate_noncontact)
  int threads = 0;  ///< 0: one per hardware thread; the result does not depend on it
  Watch watch;
};

struct CertaintyMap {
  static constexpr unsigned char uncertain = 255;

  /// Per surface sample: `uncertain`, or half the side, in samples, of the smallest square of
  /// contacts of which it is the best. 0: the tip touched here and nowhere else.
  Grid<unsigned char> level;

  HeightField surface;           ///< the erosion, of which this says how good it is
  double tolerance_nm = 0;       ///< within which contacts count: 2 sigmas noise_nm, or rounding
  int neighbourhood = 0;         ///< as used
  std::size_t image_pixels = 0;  ///< valid ones; they are of three kinds:
  std::size_t single = 0;        ///< their contacts lie within one neighbourhood, inside the image
  std::size_t ambiguous = 0;     ///< they may have touched in places farther apart, or outside
  std::size_t unexplained =
      0;  ///< no contact of this tip explains them: noise, feedback, another tip
  std::size_t surface_samples = 0, certain = 0;
};

/// Pingali and Jain's certainty map (1992; thesis, C.2.1) with a tolerance. If the noise is bounded
/// by b = sigmas noise_nm, an image pixel's true contact is among the samples x with r(x) + T(x1 -
/// x) >= h(x1) - 2 b, r the erosion, and there r is within b of the surface. If all of them lie
/// close together, the one that fits best is certain: r is within b of the surface there or at
/// another of them.
///
/// What lies outside the image may have been touched too: r is continued there. Throws InvalidInput
/// as `erode` does, and for options out of range.
CertaintyMap certainty_map(const HeightField& image, const Tip& tip,
                           const CertaintyOptions& options = {});

/// The noise of single pixels from the second differences along both axes of neighbouring samples:
/// 1.4826 / 6 of the median absolute value (Immerkaer 1996 with a median). 0 without 3 x 3 valid
/// samples anywhere. Too small for noise that is correlated from pixel to pixel; too large where
/// detail fills more than half the image.
double pixel_noise_nm(const HeightField& image);

}  // namespace surf
