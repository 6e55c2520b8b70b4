// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/overlap.h"
#include "surf/registration/register_images.h"

namespace surf {

/// A place, and how well the images agree there.
struct Place {
  Corners corners{};
  double score = 0;
  double evidence = 0;      ///< log-likelihood ratio against chance, samples taken as independent
  std::size_t samples = 0;  ///< that overlap
  bool settled = false;
};

/// One place that is followed from blur to blur.
struct Trial : Place {
  std::vector<RegistrationStep> steps;
  std::vector<Place> places;  ///< after each step
};

/// How hard to try at one blur.
struct Effort {
  int rounds = 6, iterations = 15;
  int newton_steps = 0;
};

/// Refines all trials at a level, with the objective that is given.
void refine(std::vector<Trial>& trials, const BlurLevel& level, RegistrationObjective objective,
            const Effort& effort, const RegistrationOptions& options, const Watch& watch);

/// Drops what lies outside the limits of the search, keeps of several nearer than `apart_px` the
/// best, and of all the best `kept`, best first.
void prune(std::vector<Trial>& trials, const BlurLevel& level, const CornerFrame& frame,
           const RegistrationOptions& options, double apart_px, std::size_t kept);

/// Whether scales, shear and overlap lie within the options' limits, with a little room.
bool within_limits(const Corners& corners, const BlurLevel& level, const CornerFrame& frame,
                   const RegistrationOptions& options);

}  // namespace surf
