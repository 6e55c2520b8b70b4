// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/plot.h"
#include "surf/workflow/chain_chart_job.h"

namespace surf::workflow {

/// Capture range against time, and success against offset. For summaries with registrations.
io::Plot registration_plot(const ChainChartSummary& summary);

/// Error against time, in nm and as a share of the eroded scan's error, for comparison with the
/// thesis's own points. For summaries with reconstructions.
io::Plot reconstruction_plot(const ChainChartSummary& summary);

}  // namespace surf::workflow
