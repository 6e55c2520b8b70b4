// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/io/plot.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {

/// A picture of the whole result, after the thesis's figures 10-8 to 10-11: inputs, simulated
/// images, residuals, those of at most three further views, surface, posterior standard deviations,
/// the data support or, if the truth is known, the error, and cross-sections along the row and the
/// column of most relief.
io::Plot reconstruction_panel(const ReconstructJob& job, const ReconstructSummary& summary,
                              const AfmData* afm, const SemData* sem,
                              const std::vector<SemView>& views);

}  // namespace surf::workflow
