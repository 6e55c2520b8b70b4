// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/overlap.h"
#include "surf/registration/register_images.h"

namespace surf {

struct PoseSearch {
  struct Candidate {
    Corners corners{};
    double evidence = 0;
  };
  std::vector<Candidate> candidates;  ///< best first, no two alike
  std::vector<double>
      best_of_pose;  ///< evidence of the best shift of each turn and scale, in order of size
};

/// Distance of samples, SEM pixels, and standard deviation of the blur at which a start is searched
/// for: as coarse as leaves both images enough to be known by.
double search_pitch_px(const PlacedImage& sem);

/// Tries turns and scales of a grid that leaves no place farther than about a sample away from one
/// tried, and all shifts of each. `level` is blurred by `pitch_px`.
PoseSearch search_poses(const BlurLevel& level, double pitch_px, const RegistrationOptions& options,
                        std::size_t wanted, const Watch& watch);

}  // namespace surf
