// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/core/progress.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/mc/results/simulation_result.h"

namespace surf::mc {

/// What a simulation will take, from a part of its units that were simulated and thrown away.
struct Pilot {
  std::size_t units = 0, units_in_all = 0;
  bool whole = true;   ///< else a few pixels of each of those units were tried, some more than once
  double seconds = 0;  ///< wall time that those units took, with all threads at work
  double library_seconds = 0;  ///< to get the libraries, which are there now
  std::size_t library_cascades = 0,
              library_bytes = 0;  ///< as SimulationResult, and of all materials together

  // Of the whole simulation, libraries apart. Standard errors are from how units differ.
  double expected_s = 0, standard_error_s = 0;
  std::size_t planes = 0;  ///< that pixels will be compared with, from a look at some of them
  double planes_s = 0;     ///< to make them, in `expected_s`
  double primaries = 0, rays = 0, steps = 0;
  double packed_bytes = 0;  ///< of all units' tallies, as checkpoints and messages hold them
};

/// Gets the libraries, then simulates units for about `seconds` (> 0), or all units where that
/// takes less. The units are spread evenly over the scan. It begins with a few pixels of each unit;
/// where a whole unit would take a tenth of the time or more, it goes on with such parts. Throws
/// what `simulate` throws for options, and Interrupted.
Pilot run_pilot(const Scene& scene, const SimulationOptions& options, double seconds,
                LibrarySource* libraries = nullptr, const Watch& watch = {});

}  // namespace surf::mc
