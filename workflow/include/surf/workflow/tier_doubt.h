// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "surf/mc/physics/physics.h"

namespace surf::workflow {

/// States in a sentence whether the tier `inelastic=monsel` is good enough for an accuracy (> 0):
/// by how much its images differ from those of `inelastic=dielectric` after the best gain, at 1 keV
/// (docs/explanation/dielectric.md). Returns nothing for the tier `inelastic=dielectric`.
std::optional<std::string> tier_doubt(const mc::Physics& physics, std::size_t materials,
                                      double accuracy);

}  // namespace surf::workflow
