// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/workflow/simulate_job.h"

namespace surf::workflow {

/// Gives a job the title "WHAT, FINGERPRINT". The fingerprint covers everything that determines its
/// image.
void title_by_identity(SimulateJob& job, const std::string& what);

/// Whether the job's first output is the finished image of a job with that title, so that it need
/// not be made again.
bool is_finished(const SimulateJob& job);

}  // namespace surf::workflow
