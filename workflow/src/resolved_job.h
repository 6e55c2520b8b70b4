// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A job with its request as the simulator takes it.
struct ResolvedJob : SimulateJob {
  mc::SimulationOptions options;  ///< the budget is no time limit: it is the accuracy that is
                                  ///< tried, then the one that fits

  /// Wall time, s, that the job may take; 0: any.
  double seconds() const {
    const auto* const limit = std::get_if<mc::TimeLimit>(&scene.budget);
    return limit ? limit->seconds : 0;
  }
};

}  // namespace surf::workflow
