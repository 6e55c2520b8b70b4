// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/afm/best_tip.h"
#include "surf/afm/tip_sweep.h"
#include "surf/io/plot.h"

namespace surf::cli {

/// The tip's profiles through its apex, apex down as in the microscope.
io::Plot tip_plot(const Tip& tip);

/// Before them, volume and residuals by threshold, and what was chosen.
io::Plot tip_plot(const TipSweep& sweep);

/// Before them, the risk by threshold; standard errors.
io::Plot tip_plot(const Tip& tip, const BestTipSummary& summary);

}  // namespace surf::cli
