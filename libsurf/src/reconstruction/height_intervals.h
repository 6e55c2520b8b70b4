// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// What walls may be displaced by, in pixels: the likeliest surface is one of several optima per
/// wall. Of deviations with 0.15, 0.2, 0.25 and 0.3 pixels those with 0.2 held 94.5 % of walls of
/// drawn scenes within two (90.0, 96.9 and 98.1 % the others; bench_posterior on 60 of them).
inline constexpr double edge_doubt_px = 0.2;

/// What the surface as a whole may be off by, which no draw of the linearised posterior contains.
struct CommonDoubts {
  SlopeDoubt level = {};  ///< of the scan's slopes, nm per nm
  Point2 middle = {};     ///< of the scan, in its frame, nm: where a tilt changes nothing
  double edge_px = 0;     ///< what walls may be displaced by
  PlaceDoubt place = {};  ///< what everything may be displaced by, however far
};

/// What heights may be, by draws of all unknowns.
struct HeightIntervals {
  Grid<double> deviation_nm;  ///< root mean square of the draws about the surface
  /// Quantiles of 2.5 and 97.5 % of the draws of each height.
  Grid<double> lower_nm, upper_nm;
};

/// A draw of the surface is one of the linearised posterior, tilted by a draw of the level,
/// displaced by draws of the place and of the walls'. Displacements are drawn; for each of these
/// draws all that is linear, and so normal, is integrated, and not drawn, so that few draws give
/// smooth quantiles. `soft` is the surface, smoothed, `linear_nm` the deviation of what is linear.
HeightIntervals height_intervals(const CommonDoubts& doubts, const HeightField& surface,
                                 const Grid<double>& soft, const Affine& surface_to_afm,
                                 const Grid<double>& linear_nm, int threads);

}  // namespace surf::reconstruction
