// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "resolved_job.h"
#include "surf/workflow/dry_run.h"

namespace surf::workflow {

/// What a complete job takes of disks: its scratch files, checkpoint and outputs. Sizes are of
/// uncompressed values; what is written with compression is smaller. `packed_bytes` of tallies: 0
/// takes what they mostly are.
std::vector<DiskNeed> disk_needs(const ResolvedJob& job, const mc::Scan& scan,
                                 double packed_bytes = 0);

/// Where a disk has not enough room for all of it, one warning for each such disk.
std::vector<std::string> warn_of_full_disks(const std::vector<DiskNeed>& needs);

}  // namespace surf::workflow
