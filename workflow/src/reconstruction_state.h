// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "model_correction.h"
#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// Serialize a state or a correction, and read them back. `unpack` returns nothing for bytes that
/// are not of that kind.
std::string pack(const ReconstructionState& state);
std::string pack(const ModelCorrection& correction);
std::optional<ReconstructionState> unpack(const std::string& bytes);
std::optional<ModelCorrection> unpack_correction(const std::string& bytes);

}  // namespace surf::workflow
