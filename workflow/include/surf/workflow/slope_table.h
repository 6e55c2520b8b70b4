// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/transport/tally.h"
#include "surf/sem/slope_model.h"

namespace surf::workflow {

/// The specimen on which the yield is simulated as a function of slope (thesis, appendix E.1).
enum class SlopeSpecimen {
  /// A half-space under a tilted beam. Every electron that leaves is detected, wherever it goes.
  single_plane,
  /// A tilted plane under a vertical beam, which meets a horizontal plane at its foot. Electrons
  /// that leave downward hit the ground and may set free more. The beam lands three ranges from the
  /// foot. The slope ends in a horizontal plane three ranges above that place, out of its sight. So
  /// far from both edges nothing depends on where the beam lands: the shape has no length of its
  /// own. Within a range of the foot, ground and slope act as one corner, and the yield depends on
  /// more than the slope. Beyond 80 degrees the ground catches as many secondaries as it sets free.
  two_planes,
};

struct SlopeTableOptions {
  SlopeSpecimen specimen = SlopeSpecimen::two_planes;
  double step_deg = 5;             ///< step between angles, which begin at 0; > 0
  double last_deg = 85;            ///< largest angle, 0 to 89
  std::int64_t electrons = 31000;  ///< per angle, 2 to 2^31; the default is the thesis's number
  std::uint64_t seed = 1;
  mc::Physics physics;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Yields at 0, step, 2 step ... degrees, in counts per primary. With replay the errors at
/// different angles are correlated, because all electrons come from one library.
struct SlopeTable {
  double step_deg = 5;
  std::vector<mc::Estimate> se, bse;
};

/// Simulates the table with the two default detectors. Uses replay if the physics allow it, from
/// `libraries` (null: they are made here). Throws UsageError for options out of range, Interrupted.
SlopeTable make_slope_table(const mc::Material& material, double energy_ev,
                            const SlopeTableOptions& options = {},
                            mc::LibrarySource* libraries = nullptr);

/// Makes a slope model with the channels SE and BSE from a table with at least two angles.
SlopeModelParameters to_slope_model(const SlopeTable& table);

}  // namespace surf::workflow
