// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pareto.h"
#include "surf/io/plot.h"

namespace surf::workflow {

/// The Pareto front as steps: between two points the error of the earlier one applies.
io::PlotSeries front_series(const std::vector<Trade>& trades);

}  // namespace surf::workflow
