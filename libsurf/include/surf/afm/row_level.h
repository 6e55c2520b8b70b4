// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

enum class RowMethod {
  median,      ///< each row's median becomes that of all rows: right where most of each row is
               ///< substrate
  difference,  ///< the median of the differences to the row below becomes 0: features may fill
               ///< rows, but a tilt along y goes too, and errors add up over many rows
};

struct RowLevel {
  std::vector<double> offsets_nm;  ///< taken off each row; their median is 0
  int rows_without_samples = 0;    ///< which got the offset of the nearest row that has one
};

/// Takes steps between scan lines off the heights, keeping the level of the whole. Samples that are
/// 0 in `use` (same size, or empty: all count) and holes do not decide, but are shifted with their
/// row. Throws InvalidInput if nothing remains to decide by.
RowLevel level_rows(HeightField& field, RowMethod method, const Mask& use = {});

}  // namespace surf
