// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "registration/overlap.h"

namespace surf {

/// Other places that fit as well where a pattern repeats: `best` displaced to where the AFM's image
/// looks like its own part under the SEM's, with a correlation of a half at least. The `wanted`
/// displacements with most evidence, or fewer. Asks nothing of the SEM's intensities, so that they
/// may mean anything.
std::vector<Corners> repeats_of(const BlurLevel& level, const Corners& best, std::size_t wanted);

}  // namespace surf
