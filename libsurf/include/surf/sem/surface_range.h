// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/height_field.h"

namespace surf {

/// How steep and how curved a surface is from sample to sample: what a model has seen, or is asked
/// for.
struct SurfaceRange {
  double slope_deg_p99 = 0;  ///< 99 % of the samples are no steeper
  double slope_deg_max = 0;
  double curvature_p99_per_nm = 0;  ///< of the larger of the two second derivatives along x and y
  double curvature_max_per_nm = 0;

  friend bool operator==(const SurfaceRange&, const SurfaceRange&) = default;
};

/// By differences of neighbouring samples: slopes centred (on the rim one-sided), second
/// differences inside. Throws InvalidInput for an invalid field or one with masked samples.
SurfaceRange surface_range(const HeightField& field);

/// The range that holds both: maxima, of the percentiles too.
SurfaceRange united(const SurfaceRange& a, const SurfaceRange& b);

/// Share of the samples that are steeper than `slope_deg`.
double share_steeper(const HeightField& field, double slope_deg);

}  // namespace surf
