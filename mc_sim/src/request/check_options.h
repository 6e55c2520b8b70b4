// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/request/simulation_options.h"

namespace surf::mc {

/// Throws UsageError for options out of range, or that do not go together.
void check_options(const SimulationOptions& options);

}  // namespace surf::mc
