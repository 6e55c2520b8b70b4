// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "surf/mc/simulate.h"

namespace surf::workflow {

/// Accuracy of the coarse simulation, which takes a small part of any reasonable time limit.
inline constexpr double coarse_accuracy = 0.1;

/// The input for the accuracy that fits.
struct TimeBudget {
  double seconds_left = 0;           ///< for libraries and simulation together
  std::size_t materials = 1;         ///< each needs a library
  double most_library_cascades = 0;  ///< cascades per material that fit into memory
  std::size_t cascades_made = 0;     ///< cascades of all materials, made for the coarse simulation
};

/// The accuracy that fits into the time, rounded up to two digits of a percentage, 1e-4 to
/// `coarse_accuracy`; `coarse_accuracy` if nothing better fits. Time is proportional to the number
/// of primaries, including those of planar controls, and of cascades in libraries. Both grow as 1 /
/// accuracy^2, plus a constant. A tenth of the time is kept in reserve.
double accuracy_that_fits(const mc::SimulationResult& coarse, const TimeBudget& budget);

}  // namespace surf::workflow
