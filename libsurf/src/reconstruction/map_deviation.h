// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "height_intervals.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::reconstruction {

/// How well a map is known by the walls of a surface on the SEM's samples. A wall may be displaced
/// by the deviations of its heights over their slope, and by what `doubts` say of walls, one patch
/// of a few samples apart from the next, and the map by what fits such displacements best:
/// Laplace's deviations of the map are two to three times too small, because each wall has several
/// optima. What everything may be displaced by is added. Infinite for what no wall holds.
MapDeviation map_deviation(const HeightField& soft, const Grid<double>& linear_nm,
                           const CommonDoubts& doubts, const Affine& sem_to_afm);

}  // namespace surf::reconstruction
