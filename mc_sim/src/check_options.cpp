// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_options.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf::mc {
namespace {

constexpr std::int64_t most_electrons = std::int64_t{1} << 31;
constexpr double largest_dose = 1e9;

}  // namespace

void check_options(const SimulationOptions& options) {
  if (options.electrons < 1 || options.electrons > most_electrons)
    throw UsageError("`simulation.electrons`", "the number of primaries per pixel must be 1 to 2^31",
                     "Ask for 200, say");
  if (!(options.dose >= 0 && options.dose <= largest_dose))
    throw UsageError("dose", fmt::format("{:g} primaries per pixel are outside 0 to 1e9",
                                         options.dose), "Choose a smaller current or dwell time");
  if (options.tile_pixels < 1)
    throw UsageError("tile size", "a tile needs at least one pixel", "Ask for 1024, say");
  if (options.detectors.empty())
    throw UsageError("detectors", "there are none", "Use SE and BSE");
  validate(options.detectors);
  if (options.accuracy != 0 && !(options.accuracy >= 1e-4 && options.accuracy <= 1))
    throw UsageError("`simulation.accuracy`", fmt::format("{:g} is outside 0.0001 to 1", options.accuracy),
                     "Ask for 0.01 or 1%, say");
  if (!(options.accuracy_floor >= 0 && std::isfinite(options.accuracy_floor)))
    throw UsageError("`simulation.accuracy_floor`", "it must be zero or more", "Leave it out: 0.002");
  if (options.accuracy > 0 && (options.dose > 0 || options.spectra))
    throw UsageError("`simulation.accuracy`", "pixels then get different numbers of electrons, and spectra or a "
                                   "dose would mean nothing",
                     "Give `simulation.electrons` with `simulation.spectra`, or `beam.current` and `beam.dwell` alone");
}

}  // namespace surf::mc
