// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "targets.h"

namespace surf::test {

// The targets of one kind; fuzz_targets() joins them.
std::vector<FuzzTarget> mesh_targets();
std::vector<FuzzTarget> scan_targets();
std::vector<FuzzTarget> picture_targets();
std::vector<FuzzTarget> text_targets();
std::vector<FuzzTarget> state_targets();

}  // namespace surf::test
