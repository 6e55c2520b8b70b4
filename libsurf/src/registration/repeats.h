// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "registration/overlap.h"

namespace surf {

/// Other maps that fit as well if a pattern repeats: `best`, displaced to places where the AFM's
/// image resembles its own part under the SEM's image, with a correlation of at least 0.5. Returns
/// the `wanted` displacements with the most evidence, or fewer. Uses only the AFM's intensities, so
/// the relation to the SEM's intensities does not matter.
std::vector<ThreePointMap> repeats_of(const BlurLevel& level, const ThreePointMap& best,
                                      std::size_t wanted);

}  // namespace surf
