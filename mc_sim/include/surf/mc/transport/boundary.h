// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "surf/core/vec3.h"
#include "surf/mc/geometry/beam.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/transport/observer.h"

namespace surf::mc {

/// Where a straight path meets another material.
struct BoundaryHit {
  double distance_nm = 0;   ///< along the path, >= 0
  Vec3 normal;              ///< unit normal of the boundary there, either sense
  int material_ahead = -1;  ///< index of the medium behind it; -1 is vacuum
};

/// A specimen of the caller's own (thesis, 5.4): given a start, a unit direction, a length in nm
/// (infinite in vacuum) and the material at the start (-1: vacuum), returns the first place where
/// the material changes, or nothing. It may be called from the simulating thread only.
using BoundaryFunction = std::function<std::optional<BoundaryHit>(
    const Vec3& start_nm, const Vec3& direction, double length_nm, int material)>;

/// A lower bound of the distance from a point to the nearest boundary, nm. Optional: it saves
/// calls.
using ClearanceFunction = std::function<double(const Vec3& point_nm)>;

/// What a caller's own specimen needs to be simulated.
struct CustomSpecimen {
  std::vector<const Medium*> media;  ///< not null; outlive the simulation
  BoundaryFunction boundary;         ///< required
  ClearanceFunction clearance;       ///< may be empty
};

/// Sends `electrons` primaries of `energy_ev` from `start_nm` along `direction` into a custom
/// specimen, by the same transport loop as `simulate`, with random streams (seed, pixel 0,
/// electron). If `start_material` >= 0 they start inside that material, with energy inside it.
/// Returns the counts of the two default detectors and the balance. `observer` may be null.
struct CustomResult {
  PixelTally tally;
  Counts se, bse;
  Balance balance;
};
CustomResult simulate_custom(const CustomSpecimen& specimen, const Vec3& start_nm,
                             const Vec3& direction, double energy_ev, int start_material,
                             BarrierModel barrier, std::uint64_t seed, std::int64_t electrons,
                             Observer* observer = nullptr);

}  // namespace surf::mc
