// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "simulate_options.h"
#include "surf/workflow/simulate_job.h"

namespace surf::cli {

/// What the options of `simulate` ask for. Notes go to the user unless they are quiet. Throws UsageError, FileError and
/// InvalidInput.
workflow::SimulateJob make_simulate_job(const SimulateOptions& options, const std::string& command_line,
                                       const io::BodyReader& read);

}  // namespace surf::cli
