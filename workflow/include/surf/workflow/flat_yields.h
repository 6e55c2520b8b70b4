// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/progress.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/results/simulation_result.h"

namespace surf::workflow {

/// Electrons per primary that leave a plane across the beam: below 50 eV, and from there on.
struct FlatYields {
  mc::Estimate se, bse;
  mc::Estimate total() const;
};

/// By direct simulation of `electrons` primaries. Throws Interrupted, and as Scene does.
FlatYields flat_yields(const mc::Material& material, double energy_ev, const mc::Physics& physics, std::int64_t electrons,
                       int threads = 0, const Watch& watch = {});

}  // namespace surf::workflow
