// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/grid.h"
#include "surf/core/image.h"
#include "surf/core/progress.h"
#include "surf/mc/beam.h"
#include "surf/mc/observer.h"
#include "surf/mc/physics.h"
#include "surf/mc/scene.h"
#include "surf/mc/tally.h"

namespace surf::mc {

struct SimulationOptions {
  std::int64_t electrons = 200;   ///< primaries per pixel, 1 to 2^31
  std::uint64_t seed = 1;
  int threads = 0;                ///< 0: one per hardware thread. Does not change the result
  int tile_pixels = 1024;         ///< pixels in a unit of work, >= 1. Does not change the result
};

/// A rectangle of pixels and a range of primaries: the unit of work. Tallies of units merge in any
/// order to the same result.
struct WorkUnit {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;      ///< pixels [x0, x1) x [y0, y1)
  std::int64_t first_electron = 0;
  std::int64_t electrons = 0;
};

struct UnitTally {
  Grid<PixelTally> pixels;    ///< of the unit's rectangle
  Balance balance;
};

/// Simulates one unit of work on the calling thread. With an `observer` every track is followed to
/// its end; without (null), electrons too far from any surface to matter are given up early, as
/// `simulate` does. Both have the same statistics but not the same random numbers.
UnitTally simulate_unit(const Scene& scene, std::uint64_t seed, const WorkUnit& unit,
                        Observer* observer = nullptr);

struct SimulationResult {
  Grid<PixelTally> pixels;
  Balance balance;
  bool complete = true;          ///< false when cancelled: some pixels have fewer primaries, or none
  double seconds = 0;            ///< wall time of the simulation, scene building apart
};

/// Simulates the whole scan, in parallel. On cancellation returns what is done.
/// Progress counts primaries.
SimulationResult simulate(const Scene& scene, const SimulationOptions& options,
                          const ProgressCallback& progress = {},
                          const CancelToken* cancel = nullptr);

/// Channels SE, SE.stderr, BSE, BSE.stderr and valid (1 where the beam meets the specimen and at
/// least one primary was simulated), placed in the scan plane. Yields are counts per primary.
Image make_image(const SimulationResult& result, const Scan& scan);

}  // namespace surf::mc
