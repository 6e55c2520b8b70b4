// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"
#include "surf/core/placed_image.h"

namespace surf::workflow {

/// Fills holes from their borders inwards: each hole takes the mean of its known neighbours along
/// rows and columns. A field without a valid sample is unchanged.
HeightField with_holes_filled(const HeightField& field);

/// A surface in the AFM's frame, interpolated at the pixels of an SEM image: each pixel is mapped
/// to the AFM's frame, and its height is interpolated bilinearly. Beyond the field its edge
/// continues.
struct SurfaceUnderSem {
  HeightField surface;  ///< without holes
  Mask known;           ///< 1: between valid samples of the field
  double overlap = 0;   ///< share of known pixels
};
SurfaceUnderSem surface_under_sem(const HeightField& afm_surface, const PlacedImage& sem,
                                  const Affine& sem_to_afm);

}  // namespace surf::workflow
