// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

struct StepHeight {
  double height_nm = 0;  ///< of the second region above the first, along z
  double stderr_nm = 0;  ///< one standard error, with the correlation along rows
  double slope_x = 0;    ///< common to both regions, nm per nm
  double slope_y = 0;
  double residual_nm = 0;   ///< root mean square about the two planes
  double alpha = 0;         ///< correlation of neighbours in a row of the residuals
  std::size_t samples = 0;  ///< of both regions
};

/// Two parallel planes by least squares, one through each region: as ISO 5436-1 does for profiles,
/// with a common tilt for both levels. Choose regions away from the edge between them. The standard
/// error takes the residuals as AR(1) noise along rows (`AfmNoise`), with rows independent:
/// low-frequency structure and row offsets are not in it.
/// Regions are samples that are not 0 (masks of the field's size) and not holes.
/// Throws InvalidInput if a region is empty, they overlap, or they do not determine tilt and step.
StepHeight measure_step(const HeightField& field, const Mask& first, const Mask& second);

}  // namespace surf
