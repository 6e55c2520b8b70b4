// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/afm/background.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

/// Areal height parameters (ISO 25178-2, 4.1) about the mean of the samples that take part. The
/// heights are neither levelled nor filtered first: `tilt` is the mean plane that levelling would
/// remove.
struct Roughness {
  double sa_nm = 0;         ///< mean absolute deviation
  double sq_nm = 0;         ///< root mean square deviation
  double sz_nm = 0;         ///< highest minus lowest
  double ssk = 0, sku = 3;  ///< skewness, kurtosis (0, 3 for a normal distribution)
  double mean_nm = 0;
  std::size_t samples = 0;
  Plane tilt;                 ///< the mean plane left in the heights
  double sq_levelled_nm = 0;  ///< Sq after subtraction of `tilt`
};

/// Holes and samples that are 0 in `use` (same size, or empty: all count) do not count. Throws
/// InvalidInput as `fit_plane` does.
Roughness measure_roughness(const HeightField& field, const Mask& use = {});

}  // namespace surf
