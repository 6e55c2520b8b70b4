// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/geometry/scene.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/mc/results/unit_tally.h"
#include "surf/mc/transport/observer.h"

namespace surf::mc {

/// Simulates one unit of work on the calling thread. With an `observer` every track is followed to
/// its end; without (null), electrons too far from any surface to matter are given up early, as
/// `simulate` does. Both have the same statistics but not the same random numbers.
/// Of the options, seed, dose, detectors and spectra count.
UnitTally simulate_unit(const Scene& scene, const SimulationOptions& options, const WorkUnit& unit,
                        Observer* observer = nullptr);

}  // namespace surf::mc
