// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pareto.h"
#include "surf/io/plot.h"

namespace surf::workflow {

/// The Pareto front as steps: between two of its points the earlier one's error is to be had.
io::PlotSeries front_series(const std::vector<Trade>& trades);

}  // namespace surf::workflow
