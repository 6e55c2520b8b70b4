// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "surf/workflow/profile_job.h"

namespace surf::workflow {

/// Writes what a profile job found into its folder; returns the files.
std::vector<std::filesystem::path> write_profile(const ProfileJob& job,
                                                 const ProfileSummary& summary);

}  // namespace surf::workflow
