// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/registration/register_images.h"

namespace surf {

/// What is known when a registration is judged.
struct Evidence {
  bool any_place = true;  ///< something overlapped and agreed at all
  bool searched = false;  ///< else it began where it was told to
  bool settled = true, within_limits = true;
  double score = 0, score_error = 0;
  bool slid_off = false;       ///< every place that fitted left the limits while it was refined
  double coarse_evidence = 0;  ///< of the best place, as coarse as the search was
  double best_coarse_evidence =
      0;                ///< of any place: patterns that slide end far from where they began
  bool related = true;  ///< some place agreed better than chance, whether or not it is the best one
  double chance_evidence = 0;  ///< what chance reaches once in a thousand such searches
  double loosest_px = 0;       ///< standard error along the motion that is known least
  double repeat_px =
      0;  ///< from a start: to the nearest place where the scan looks alike; 0: there is none
  double largest_stderr_px = 0, rival_sigmas = 4;  ///< the options'
};

/// Sets verdict and reason; `rivals` must be filled in.
void judge(Registration& registration, const Evidence& evidence);

/// What the best of so many wrong poses exceeds once in `odds` searches, by the law of extremes:
/// each pose's best shift is a maximum of many, so that the poses' values, in order of size, follow
/// Gumbel's distribution; its place and scale come from their lower half, which a true pose and its
/// neighbours leave alone.
double chance_bound(const std::vector<double>& best_of_pose, double odds);

}  // namespace surf
