// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model_correction.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// Serialize a state or the corrections of a round, and read them back. `unpack` returns nothing
/// for bytes that are not of that kind.
std::string pack(const ReconstructionState& state);
std::string pack(const std::vector<ModelCorrection>& corrections);
std::optional<ReconstructionState> unpack(const std::string& bytes);
std::optional<std::vector<ModelCorrection>> unpack_corrections(const std::string& bytes);

}  // namespace surf::workflow
