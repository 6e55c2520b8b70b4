// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// What the surface as a whole may be off by, which no draw of the posterior contains.
struct CommonDoubts {
  SlopeDoubt level = {};  ///< of the scan's slopes, nm per nm
  Point2 middle = {};     ///< of the scan, in its frame, nm: where a tilt changes nothing
  double edge_px = 0;     ///< what walls may be displaced by
  PlaceDoubt place = {};  ///< what everything may be displaced by, however far
  std::uint64_t seed = 1;
};

/// Adds them, in squares, to the deviations of heights. `soft` is the surface, smoothed.
void add(const CommonDoubts& doubts, const HeightField& surface, const Grid<double>& soft,
         const Affine& surface_to_afm, Grid<double>& deviation_nm);

}  // namespace surf::reconstruction
