// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "compare/window_scores.h"
#include "surf/compare/find_changes.h"

namespace surf {

/// Connected samples (by edge or corner) that changed to one side.
struct ChangedRegion {
  std::vector<std::size_t> samples;  // row-major indices, ascending
  double score = 0;                  // of its strongest window
};

/// Regions of samples whose `score` is not 0, by its sign; strongest first.
std::vector<ChangedRegion> connected_regions(const Grid<double>& score);

/// What is said of a region.
ChangedPlace describe_region(const ChangedRegion& region, const MeasuredDifference& measured,
                             const DifferenceErrors& errors);

}  // namespace surf
