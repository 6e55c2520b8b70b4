// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "surf/mc/request/simulation_options.h"

namespace surf::mc {

/// What a primary counts on average on a plane across the beam, of one material in one detector.
struct CascadeYield {
  double mean = 0, variance = 0;
};

/// The part of a wanted variance that a library's own share may take. A pixel takes no cascade twice, and
/// shares the smaller part of its cascades with others: no more than a quarter is common to all. The
/// means on planes are over all of them. (A pilot finds a variance a little low at times.)
inline constexpr double usual_share_of_variance = 0.24;

/// How many cascades of each material replay with these options takes, where no pixel has more than
/// `most_primaries`. With an accuracy (2 / share)^2, the least that any use can be made of, and where `yields` are known as many as
/// it takes for the library's share to be `share` of the variance asked for, 0 to 1.
std::size_t library_size(const SimulationOptions& options, std::int64_t most_primaries,
                         std::span<const CascadeYield> yields = {}, double share = usual_share_of_variance);

}  // namespace surf::mc
