// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/plot.h"
#include "surf/workflow/chart_job.h"

namespace surf::workflow {

/// Time against error, SE and BSE: above with all that it takes from nothing, below with scene,
/// library and model made before.
io::Plot chart_plot(const ChartJob& job, const ChartSummary& summary);

}  // namespace surf::workflow
