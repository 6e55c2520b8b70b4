// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/workflow/refine_job.h"

namespace surf::workflow {

/// Writes what was found to the job's folder. Returns the files.
std::vector<std::filesystem::path> write_refined(const RefineJob& job, const RefineSummary& s);

}  // namespace surf::workflow
