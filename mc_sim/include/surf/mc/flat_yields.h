// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/progress.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// Electrons per primary that leave a bare half-space across the beam, in the default detectors.
struct FlatYields {
  Estimate se, bse;
};

/// By direct simulation of at least `electrons` primaries on `threads` threads (0: one per hardware
/// thread). Throws Interrupted, and as Scene does.
FlatYields flat_yields(const Material& material, double energy_ev, std::int64_t electrons,
                       const Physics& physics = {}, int threads = 0, const Watch& watch = {});

}  // namespace surf::mc
