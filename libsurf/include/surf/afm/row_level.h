// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/core/height_field.h"
#include "surf/core/mask.h"

namespace surf {

enum class RowMethod {
  /// Makes the median of each row equal: right if most of each row is substrate.
  median,
  /// Makes the median difference to the row below 0. Features may fill rows, but a tilt along y is
  /// removed too, and errors add up over many rows.
  difference,
};

struct RowLevel {
  std::vector<double> offsets_nm;  ///< subtracted from each row; their median is 0
  int rows_without_samples = 0;    ///< they get the offset of the nearest row with samples
};

/// Removes steps between scan lines and keeps the overall level. Holes and samples that are 0 in
/// `use` (same size, or empty: all count) do not influence the offsets, but are shifted with their
/// row. Throws InvalidInput if no sample is left.
RowLevel level_rows(HeightField& field, RowMethod method, const Mask& use = {});

}  // namespace surf
