// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/background.h"
#include "surf/core/affine.h"
#include "surf/core/height_field.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf {

/// What a surface is still tilted by, by its SEM image.
struct SemTilt {
  double x = 0, y = 0;  ///< slopes to add to the heights, along the scan's axes, nm per nm
  SlopeDoubt doubt;     ///< their standard errors, what was known beforehand included
  int iterations = 0;
};

/// A scan does not say what is level: the plane taken off it is known to within standard errors of
/// its slopes. Yields depend on slopes, so the tilt of `surface` that makes the image likeliest,
/// gains and offset with it, is found by Gauss-Newton. Beforehand the tilt is expected as `before`,
/// and the model's discrepancy is in the weights. `surface` is on the image's pixels. Throws as
/// `reconstruct`.
SemTilt tilt_by_sem(const HeightField& surface, const SemData& sem, const Affine& sem_to_afm,
                    const SemTilt& before, int threads = 0);

}  // namespace surf
