// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// Compares the reconstruction with the true heights, which are interpolated at its samples. Throws
/// InvalidInput if the two have fewer than 16 places in common.
TruthReport compare_with_truth(const Reconstruction& result, const HeightField& truth);

/// The pixels of a region, as RegionReport names them.
struct PixelRegion {
  const char* name = "";
  Mask pixels;
};
/// Regions by the slopes of the true heights and by what the tip touched: all, flat, wall, foot and
/// untouched. Without `data_support` (see Reconstruction) no pixel is untouched.
std::vector<PixelRegion> pixel_regions(const HeightField& truth,
                                       const Grid<unsigned char>& data_support);

/// The true heights at the samples of a surface in the same frame; invalid beyond them.
HeightField truth_on(const HeightField& surface, const HeightField& truth);

/// Root mean square difference at the surface's samples that are valid in both, with the mean
/// difference taken off.
double rms_off(const HeightField& surface, const HeightField& truth);

}  // namespace surf::workflow
