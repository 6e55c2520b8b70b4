// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/workflow/dry_run.h"

namespace surf::cli {

/// What a simulation would take, as `simulate --dry-run` tells it.
void print_dry_run(const workflow::DryRun& run);

}  // namespace surf::cli
