// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/simulate_job.h"

namespace surf::cli {

/// What was simulated, how, and what came out, for people.
void print_summary(const workflow::SimulateJob& job, const workflow::SimulateSummary& summary);

}  // namespace surf::cli
