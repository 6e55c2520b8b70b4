// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>

#include "chain_options.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::cli {

void add_reconstruct_options(CLI::App& app, ChainOptions& options);

/// Reads the inputs. Throws UsageError, FileError, InvalidInput.
workflow::ReconstructJob make_reconstruct_job(const ChainOptions& options);

}  // namespace surf::cli
