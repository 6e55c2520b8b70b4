// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/grid.h"

namespace surf::bench {

/// Means of 2 x 2 samples; of fewer at an odd border.
Grid<double> halved(const Grid<double>& from);

/// Bilinear between samples of `halved`, on width x height samples.
Grid<double> doubled(const Grid<double>& from, int width, int height);

/// The coarsest first, `levels` in all; fewer if one would have less than 8 samples along a side.
std::vector<Grid<double>> pyramid(const Grid<double>& finest, int levels);

/// From one level to a finer one, or unchanged.
Grid<double> refined(Grid<double> from, int width, int height);

}  // namespace surf::bench
