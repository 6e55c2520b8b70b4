// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/mc/simulate.h"

namespace surf::workflow {

/// What a coarse simulation aims at: it takes a fraction of what anyone would wait for.
inline constexpr double coarse_accuracy = 0.1;

/// What is known when the accuracy that fits is asked for.
struct TimeBudget {
  double seconds_left = 0;           ///< for libraries and simulation together
  std::size_t materials = 1;         ///< each needs a library
  double most_library_cascades = 0;  ///< of each material, that fit into memory
  std::size_t cascades_made = 0;     ///< of all materials, for the coarse simulation
};

/// The accuracy that fits, rounded up to two digits of a percentage, 1e-4 to `coarse_accuracy`; the
/// latter too where nothing better fits. Time goes with the number of primaries, those of planes
/// that pixels are compared with among them, and of cascades in libraries: about 1 / accuracy^2 of
/// the one and the other, plus what does not depend on it. A tenth of the time is kept in reserve.
double accuracy_that_fits(const mc::SimulationResult& coarse, const TimeBudget& budget);

}  // namespace surf::workflow
