// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// Serialize a state, and read it back. `unpack` returns nothing for bytes that are not a state.
std::string pack(const ReconstructionState& state);
std::optional<ReconstructionState> unpack(const std::string& bytes);

}  // namespace surf::workflow
