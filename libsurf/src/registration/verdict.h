// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/registration/register_images.h"

namespace surf {

/// The facts that the verdict on a registration is based on.
struct Evidence {
  bool any_place = true;  ///< whether the images overlapped and agreed anywhere
  bool searched = false;  ///< false: an initial map was given
  bool settled = true, within_limits = true;
  double score = 0, score_error = 0;
  /// Whether every map that fitted left the limits during the refinement.
  bool slid_off = false;
  double coarse_evidence = 0;  ///< evidence of the best map, at the blur of the search
  /// Largest evidence of any map at the blur of the search. Sliding patterns end far from where
  /// they began.
  double best_coarse_evidence = 0;
  /// Whether any map, not necessarily the best one, agreed better than chance.
  bool related = true;
  double chance_evidence = 0;  ///< evidence that chance reaches once in a thousand such searches
  double loosest_px = 0;       ///< standard error along the least known motion
  /// With a given initial map: distance to the nearest place where the scan resembles itself; 0:
  /// there is none.
  double repeat_px = 0;
  double largest_stderr_px = 0, rival_sigmas = 4;  ///< from the options
};

/// Sets verdict and reason; `rivals` must be set before.
void judge(Registration& registration, const Evidence& evidence);

/// The evidence that the best of this many wrong poses exceeds once in `odds` searches, by extreme
/// value theory. Each pose's best shift is a maximum of many values, so the sorted values of the
/// poses follow Gumbel's distribution. Its location and scale are estimated from the lower half of
/// the values, which a true pose and its neighbours do not influence.
double chance_bound(const std::vector<double>& best_of_pose, double odds);

}  // namespace surf
