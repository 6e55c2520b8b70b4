// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/overlap.h"
#include "surf/registration/register_images.h"

namespace surf {

/// A map, and how well the images agree under it.
struct Place {
  ThreePointMap corners{};
  double score = 0;
  double evidence = 0;      ///< log-likelihood ratio against chance, for independent samples
  std::size_t samples = 0;  ///< number of samples that overlap
  bool settled = false;
};

/// A candidate map that is refined from blur to blur.
struct MapCandidate : Place {
  std::vector<RegistrationStep> steps;
  std::vector<Place> places;  ///< after each step
};

/// The computational effort at one blur.
struct Effort {
  int rounds = 6, iterations = 15;
  int newton_steps = 0;
};

/// Refines all candidates at a level with the given objective.
void refine(std::vector<MapCandidate>& candidates, const BlurLevel& level,
            RegistrationObjective objective, const Effort& effort,
            const RegistrationOptions& options, const Watch& watch);

/// Drops candidates outside the limits of the search. Keeps the best of several candidates closer
/// than `apart_px`, and of all of them the best `kept`, best first.
void prune(std::vector<MapCandidate>& candidates, const BlurLevel& level,
           const ThreePointFrame& frame, const RegistrationOptions& options, double apart_px,
           std::size_t kept);

/// Whether scales, shear and overlap are within the options' limits, with a little tolerance.
bool within_limits(const ThreePointMap& corners, const BlurLevel& level,
                   const ThreePointFrame& frame, const RegistrationOptions& options);

}  // namespace surf
