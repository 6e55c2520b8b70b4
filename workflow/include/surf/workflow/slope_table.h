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

/// What a yield as a function of slope is simulated on (thesis, appendix E.1).
enum class SlopeSpecimen {
  /// A half-space under a tilted beam: what leaves is detected, wherever it goes.
  single_plane,
  /// A plane tilted under a vertical beam, which meets a horizontal one at its foot: what leaves
  /// downward hits
  /// the ground and may set free more. The beam lands three ranges from the foot, and the slope
  /// ends in a
  /// horizontal plane three ranges above it, out of its sight. So far from both edges nothing
  /// depends on where
  /// it lands: the shape has no length of its own. Nearer to the foot, within the range, ground and
  /// slope are
  /// one corner, which is no matter of slope. Beyond 80 degrees the ground catches as many
  /// secondaries as it
  /// sets free.
  two_planes,
};

struct SlopeTableOptions {
  SlopeSpecimen specimen = SlopeSpecimen::two_planes;
  double step_deg = 5;             ///< between angles, which begin at 0; > 0
  double last_deg = 85;            ///< no angle beyond it, 0 to 89
  std::int64_t electrons = 31000;  ///< per angle, 2 to 2^31: the thesis's number
  std::uint64_t seed = 1;
  mc::Physics physics;
  int threads = 0;  ///< 0: one per hardware thread. Does not change the result
  Watch watch;
};

/// Yields at 0, step, 2 step ... degrees, in counts per primary. Errors of different angles are
/// correlated where electrons are replayed, as they come from one library.
struct SlopeTable {
  double step_deg = 5;
  std::vector<mc::Estimate> se, bse;
};

/// By Monte Carlo, with the two default detectors; replayed where the physics allow it, from
/// `libraries` (null: they are made on the spot). Throws UsageError for options out of range,
/// Interrupted.
SlopeTable make_slope_table(const mc::Material& material, double energy_ev,
                            const SlopeTableOptions& options = {},
                            mc::LibrarySource* libraries = nullptr);

/// A slope model with the channels SE and BSE of the table, of two angles or more.
SlopeModelParameters to_slope_model(const SlopeTable& table);

}  // namespace surf::workflow
