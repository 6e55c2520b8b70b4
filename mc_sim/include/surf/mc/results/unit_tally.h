// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surf/core/grid.h"
#include "surf/mc/transport/spectra.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// A rectangle of pixels and a range of primaries: the unit of work. Tallies of units merge in any
/// order to the same result.
struct WorkUnit {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels [x0, x1) x [y0, y1)
  std::int64_t first_electron = 0;
  std::int64_t electrons = 0;
};

struct UnitTally {
  Grid<PixelTally> pixels;               ///< of the unit's rectangle
  std::vector<Grid<Counts>> counts;      ///< per detector
  std::vector<Grid<Counts>> odd_counts;  ///< per detector, of odd primaries, where asked for
  std::vector<Grid<Control>> controls;   ///< per detector, with `accuracy`
  std::vector<Spectra> spectra;          ///< per detector, where asked for
  Balance balance;
};

/// A unit's tallies, all zero.
void clear(UnitTally& tally, const WorkUnit& unit, std::size_t detectors);

}  // namespace surf::mc
