// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "surf/mc/results/simulation_result.h"

namespace surf::mc {

/// The standard error that this accuracy asks for of a detector whose mean yield at a pixel this
/// is.
inline double target(const SimulationResult& r, std::size_t d, double mean, double accuracy) {
  return std::max(accuracy * mean, floor_of(r.budget) * r.detectors[d].efficiency);
}

/// Visits all pixels that see the specimen.
template <class Visit>
void for_seen_pixels(const SimulationResult& r, const Visit& visit) {
  for (int y = 0; y < r.pixels.height(); ++y) {
    for (int x = 0; x < r.pixels.width(); ++x)
      if (r.pixels(x, y).hits > 0) visit(x, y);
    r.release();
  }
}

}  // namespace surf::mc
