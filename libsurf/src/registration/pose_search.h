// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "registration/overlap.h"
#include "surf/registration/register_images.h"

namespace surf {

struct PoseSearch {
  struct Candidate {
    ThreePointMap corners{};
    double evidence = 0;
  };
  std::vector<Candidate> candidates;  ///< best first, all of them different
  /// Evidence of the best shift for each rotation and scale, in increasing order.
  std::vector<double> best_of_pose;
};

/// Distance of samples, in SEM pixels, and standard deviation of the blur for the search: as coarse
/// as possible while both images remain recognisable.
double search_pitch_px(const PlacedImage& sem);

/// Tries rotations and scales on a grid, and all shifts for each of them. The grid is so fine that
/// some tried map places every point within about a sample of its true position. `level` is blurred
/// by `pitch_px`.
PoseSearch search_poses(const BlurLevel& level, double pitch_px, const RegistrationOptions& options,
                        std::size_t wanted, const Watch& watch);

}  // namespace surf
