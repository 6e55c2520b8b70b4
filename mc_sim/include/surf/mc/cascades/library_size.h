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

/// The part of a wanted variance that may come from the finite library. A pixel takes no cascade
/// twice, and no more than a quarter of its variance is common to all pixels. Means on planes are
/// over all cascades. The value is a little below a quarter because a pilot sometimes finds too
/// small a variance.
inline constexpr double usual_share_of_variance = 0.24;

/// The number of cascades of each material that replay needs, in whole pages.
///
/// Without an accuracy it is `most_primaries`, the largest number of primaries of any pixel, over
/// `share`. With an accuracy a it is (2 / a)^2 at least, since a smaller library cannot reach it.
/// Where `yields` are known, it is also large enough for the library's part of the wanted variance
/// to be no more than `share`, 0 to 1.
std::size_t library_size(const SimulationOptions& options, std::int64_t most_primaries,
                         std::span<const CascadeYield> yields = {},
                         double share = usual_share_of_variance);

}  // namespace surf::mc
