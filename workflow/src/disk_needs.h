// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "resolved_job.h"
#include "surf/workflow/dry_run.h"

namespace surf::workflow {

/// The disk space of a complete job: its scratch files, checkpoint and outputs. Sizes are for
/// uncompressed values; compressed files are smaller. `packed_bytes` is the serialized size of the
/// tallies; 0 assumes a typical size.
std::vector<DiskNeed> disk_needs(const ResolvedJob& job, const mc::Scan& scan,
                                 double packed_bytes = 0);

/// One warning for each disk without enough room for all its files.
std::vector<std::string> warn_of_full_disks(const std::vector<DiskNeed>& needs);

}  // namespace surf::workflow
