// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/plot.h"
#include "surf/workflow/chart_job.h"

namespace surf::workflow {

/// Time against error, SE and BSE: the upper panels with the preparation, the lower ones with
/// scene, library and model already made.
io::Plot chart_plot(const ChartJob& job, const ChartSummary& summary);

}  // namespace surf::workflow
