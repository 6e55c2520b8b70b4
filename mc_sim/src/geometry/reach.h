// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/mc/geometry/beam.h"
#include "surf/mc/physics/medium.h"

namespace surf::mc {

/// How far electrons of a beam get.
struct Reach {
  double of_any_nm = 0;       ///< in the material where that is farthest (`reach_nm`)
  double through_all_nm = 0;  ///< where a path leads through all materials one after the other
};

std::vector<Medium> make_media(const std::vector<Material>& materials, const Physics& physics);

Reach reach_of(const std::vector<Medium>& media, const Beam& beam);

}  // namespace surf::mc
