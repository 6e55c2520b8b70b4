// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/height_field.h"

namespace surf {

/// The range of slopes and curvatures of a surface from sample to sample: of the surfaces that a
/// model was trained on, or of one that it is applied to.
struct SurfaceRange {
  double slope_deg_p99 = 0;  ///< 99 % of the samples are no steeper
  double slope_deg_max = 0;
  double curvature_p99_per_nm = 0;  ///< of the larger second derivative along x or y
  double curvature_max_per_nm = 0;

  friend bool operator==(const SurfaceRange&, const SurfaceRange&) = default;
};

/// Measures by differences of neighbouring samples: central differences for slopes (one-sided at
/// the rim), second differences inside. Throws InvalidInput for an invalid field or one with masked
/// samples.
SurfaceRange surface_range(const HeightField& field);

/// The range that contains both: the maxima, also of the percentiles.
SurfaceRange united(const SurfaceRange& a, const SurfaceRange& b);

/// The share of the samples that are steeper than `slope_deg`.
double share_steeper(const HeightField& field, double slope_deg);

}  // namespace surf
