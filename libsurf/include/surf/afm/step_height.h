// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

struct StepHeight {
  double height_nm = 0;  ///< height of the second region above the first, along z
  double stderr_nm = 0;  ///< standard error, including the correlation along rows
  double slope_x = 0;    ///< common to both regions, nm per nm
  double slope_y = 0;
  double residual_nm = 0;   ///< root mean square distance from the two planes
  double alpha = 0;         ///< correlation of neighbouring residuals in a row
  std::size_t samples = 0;  ///< in both regions together
};

/// Fits two parallel planes by least squares, one through each region, as ISO 5436-1 does for
/// profiles but with a common tilt. Choose regions away from the edge between them. The standard
/// error assumes that the residuals are AR(1) noise along rows (`AfmNoise`) and that rows are
/// independent; it does not include low-frequency structure and row offsets. A region consists of
/// the samples that are not 0 in its mask (of the field's size) and not holes. Throws InvalidInput
/// if a region is empty, the regions overlap, or they do not determine tilt and step.
StepHeight measure_step(const HeightField& field, const Mask& first, const Mask& second);

}  // namespace surf
