// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "max_plus.h"

namespace surf::max_plus {

inline constexpr int block = 32;

/// For each place of a block: the first and last columns and lines of the reversed b that touch.
/// Columns are counted from the end and from the beginning; 0: no column touches.
struct Found {
  std::array<int, block> from_end, from_begin, l0, l1;
  std::array<int, block> in_line;  ///< whether the current line touches
};

}  // namespace surf::max_plus
