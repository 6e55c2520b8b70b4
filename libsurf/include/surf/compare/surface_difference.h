// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/compare/align_surfaces.h"
#include "surf/core/grid.h"
#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

/// Heights of `after`, moved onto the samples of `before`, less those of `before`.
struct SurfaceDifference : Placement {
  Grid<double> difference_nm;  ///< 0 where not valid
  /// Estimated error of interpolating `after` between its samples and of the places of single
  /// walls, one standard deviation. It is large at walls that are steeper than the samples show,
  /// and 0 elsewhere.
  Grid<double> interpolation_nm;
  /// Errors that the uncertainty of the alignment makes over the whole field. Each is a pattern
  /// times an independent number of variance 1.
  std::vector<Grid<double>> common_nm;
  /// What interpolation leaves of the deviation of errors of `after`, if those of neighbouring
  /// samples are independent, (0, 1].
  double averaged_share = 1;
  Mask valid;
};

/// Interpolates `after` by cubic convolution (Keys 1981, doi:10.1109/TASSP.1981.1163711). A sample
/// is a hole if one of the 4 x 4 samples that it is interpolated from is a hole or missing. The
/// error of interpolation is taken from second differences, which are large where samples do not
/// resolve the surface. What noise makes of second differences everywhere is taken off. Throws
/// InvalidInput if hardly anything overlaps.
SurfaceDifference surface_difference(const HeightField& before, const HeightField& after,
                                     const SurfaceAlignment& alignment);

/// Values that belong to the samples of `after`, such as deviations, at the samples of `before`:
/// the largest of the four around each. 0 outside.
Grid<double> moved_deviation(const HeightField& before, const HeightField& after,
                             const Grid<double>& deviation_nm, const SurfaceAlignment& alignment);

}  // namespace surf
