// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/workflow/simulate_job.h"

namespace surf::cli {

/// What was simulated, how, and what came out, for people. `threads`: as asked for, 0 for all.
void print_summary(int threads, const workflow::SimulateSummary& summary);

/// What guides have brought, in words that follow a detector's name.
std::string format_gain(const workflow::GuidedGain& gain);

}  // namespace surf::cli
