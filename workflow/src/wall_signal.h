// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surf/core/progress.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/physics/material.h"
#include "surf/mc/physics/physics.h"
#include "surf/profile/feature_shape.h"

namespace surf::workflow {

/// How the signal across a wall is simulated: at u = first + k step, as ProfileLibrary has it.
struct WallSimulation {
  mc::Material material;
  mc::Physics physics;
  double energy_ev = 1000, spot_nm = 0;
  double tilt_deg = 0, azimuth_deg = 0;  ///< of the beam
  std::string signal = "SE";             ///< see `detectors_of`
  bool left = false;  ///< the wall at the left of the feature's middle, not that at its right
  double first_u_nm = -100, step_nm = 1;
  int places = 200;
  std::int64_t electrons = 1000;  ///< per place
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Yields and their standard errors.
struct WallSignal {
  std::vector<double> mean, standard_error;
};

/// The signal across a wall of a feature, along the image's x in the plane perpendicular to the
/// beam, from the middle of the wall's flank; of a hole, along a radius. Throws Interrupted, and
/// InvalidInput for shapes that `feature_mesh` refuses.
WallSignal simulate_wall(const FeatureShape& shape, const WallSimulation& simulation,
                         mc::LibrarySource& libraries, const Watch& watch = {});

/// Standard deviation of the spot where it is a sum over neighbouring places, whose errors are not
/// independent then; 0: electrons are drawn from the spot, which is small.
double blurred_by_nm(const WallSimulation& simulation);

}  // namespace surf::workflow
