// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "surf/mc/geometry/beam.h"
#include "surf/mc/geometry/specimen.h"
#include "surf/mc/physics/physics.h"
#include "surf/mc/request/budget.h"
#include "surf/mc/request/scan_request.h"
#include "surf/mc/request/simulation_options.h"
#include "surf/mc/transport/detector.h"

namespace surf::mc {

/// One image to simulate: what the beam looks at, how, and how much. Scene files, command lines,
/// the plugin and programs make one; jobs do it.
struct SimulationRequest {
  std::string title;
  Specimen specimen;
  Beam beam;
  ScanRequest scan;
  std::vector<Detector> detectors;  ///< besides SE and BSE
  Physics physics;
  Budget budget;
  std::optional<Method> method;  ///< absent: semsurf chooses
  double mesh_tolerance_nm = 0;  ///< what may be simplified, >= 0; 0: nothing
  std::uint64_t seed = 1;
};

/// All but title and specimen.
void describe(ParameterVisitor& visit, SimulationRequest& request);

/// Throws UsageError for what cannot be asked: numbers out of range, detectors of one name.
void validate(const SimulationRequest& request);

/// As the simulator takes it. `method` is direct where the request has none, a time limit stays
/// one.
SimulationOptions options_of(const SimulationRequest& request, const Execution& execution = {});

}  // namespace surf::mc
