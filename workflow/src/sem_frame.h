// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/placed_image.h"

namespace surf::workflow {

/// Holes take the height of the nearest sample, counted in steps along rows and columns; of several
/// the mean. A field without a valid sample stays as it is.
HeightField with_holes_filled(const HeightField& field);

/// A surface of the AFM's frame on the pixels of an SEM image: each at the place that the map says,
/// between samples in proportion to the four around. Beyond the field its edge goes on.
struct SurfaceUnderSem {
  HeightField surface;  ///< whole
  Mask known;           ///< 1: between samples of the field that are no holes
  double overlap = 0;   ///< share of the pixels that are
};
SurfaceUnderSem surface_under_sem(const HeightField& afm_surface, const PlacedImage& sem,
                                  const Affine& sem_to_afm);

}  // namespace surf::workflow
