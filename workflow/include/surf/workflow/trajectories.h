// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "surf/core/track.h"
#include "surf/mc/geometry/scene.h"

namespace surf::workflow {

/// Tracks of primaries that land in one pixel, for viewing.
struct Trajectories {
  std::vector<Track> tracks;  ///< in the order of simulation
  double inside_nm = 0;       ///< longest side of the box around the primaries' paths inside matter
  double exit_nm = 0;         ///< distance to which leaving electrons are followed
};

/// Simulates `primaries` (>= 1) electrons at a place in the scan plane, nm; absent: the middle of
/// the scan. Throws UsageError for a place outside the scan.
Trajectories record_trajectories(const mc::Scene& scene, std::uint64_t seed, int primaries,
                                 const std::optional<std::pair<double, double>>& at_nm = {});

}  // namespace surf::workflow
