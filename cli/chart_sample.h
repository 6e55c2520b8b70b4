// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "surf/workflow/chain_chart_job.h"

namespace surf::cli {

/// A time as charts print it: "1.23 s", "45.6 ms".
std::string time_text(double seconds);

/// The part of the help that lists the methods for samples.
std::string chart_sample_methods();

/// Registration and reconstruction of a folder that `semsurf sample` made: the exit code.
int chart_sample(workflow::ChainChartJob job, bool quiet);

}  // namespace surf::cli
