// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "surf/mc/cascades/cascade_library.h"

namespace surf::workflow {

// A page of cascades as bytes, lowest byte first: the number of starts and the number of words, 8
// bytes each; the words; the starts, 4 bytes each.

std::vector<std::byte> page_to_bytes(const mc::CascadePage& page);

/// Reads a page. Returns nothing if the number of bytes differs from the counts. The meaning of the
/// words is not checked.
std::optional<mc::CascadePage> page_from_bytes(std::span<const std::byte> bytes);

}  // namespace surf::workflow
