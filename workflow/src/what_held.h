// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "surf/reconstruction/reconstruct.h"

namespace surf::workflow {

/// Says in words which image holds which part of a surface: its gentle parts, and the walls of each
/// direction that are at least a two-hundredth of it. Empty without deviations.
std::vector<std::string> what_held(const Reconstruction& result);

}  // namespace surf::workflow
