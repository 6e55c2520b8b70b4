// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "surf/core/grid.h"

namespace surf::io {

/// A PNG of 8-bit grey in memory, without any text. Row 0 of the grid is the lowest.
std::string png_bytes(const Grid<std::uint8_t>& grey);

}  // namespace surf::io
