// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// A job with its request in the form of simulation options.
struct ResolvedJob : SimulateJob {
  /// The budget is never a time limit: it is the accuracy that is tried, then the one that fits the
  /// time.
  mc::SimulationOptions options;

  /// Limit of the job's wall time, s; 0: none.
  double seconds() const {
    const auto* const limit = std::get_if<mc::TimeLimit>(&scene.budget);
    return limit ? limit->seconds : 0;
  }
};

}  // namespace surf::workflow
