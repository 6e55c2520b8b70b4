// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "surf/mc/physics/material.h"

namespace surf::mc {

/// That the material was taken for a metal, though a quarter of its atoms or more make insulators
/// or semiconductors of most compounds: N, P, As, O, S, Se, Te, F, Cl, Br, I, or H with C.
std::optional<std::string> doubt_of_a_metal(const Material& material);

/// What a person should know before trusting images of this material: `doubt_of_a_metal`, and which
/// of its numbers are estimates. E_b is left out: `loss_join_fitted` tells of it. See
/// docs/explanation/materials.md.
std::vector<std::string> doubts(const Material& material);

}  // namespace surf::mc
