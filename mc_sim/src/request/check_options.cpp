// SPDX-License-Identifier: GPL-3.0-or-later
#include "request/check_options.h"

#include <variant>

#include "surf/core/error.h"

namespace surf::mc {
void check_options(const SimulationOptions& options) {
  validate(options.budget);
  if (std::holds_alternative<TimeLimit>(options.budget))
    throw UsageError("`simulation.time`", "the simulator itself knows no clock",
                     "Run it as a job, or give `simulation.accuracy`");
  if (options.tile_pixels < 1)
    throw UsageError("tile size", "a tile needs at least one pixel", "Ask for 1024, say");
  if (options.detectors.empty()) throw UsageError("detectors", "there are none", "Use SE and BSE");
  validate(options.detectors);
  if (accuracy_of(options.budget) > 0 && (options.odd_counts || options.primaries))
    throw UsageError("`simulation.accuracy`",
                     "pixels then get as many primaries as they need, some compared with a plane",
                     "Give a number of electrons, or simulate round by round");
  if (accuracy_of(options.budget) > 0 && options.spectra)
    throw UsageError(
        "`simulation.accuracy`",
        "pixels then get different numbers of electrons, and spectra would mean nothing",
        "Give `simulation.electrons` with `output.spectra`");
}

}  // namespace surf::mc
