// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>

#include "surf/core/grid.h"

namespace surf {

/// Selects samples of a grid: those that are not 0. An empty mask selects all samples; any other
/// mask has the size of its grid.
class Mask : public Grid<unsigned char> {
 public:
  using Grid::Grid;
  explicit Mask(Grid<unsigned char> grid) : Grid(std::move(grid)) {}

  /// Whether the mask selects this sample.
  bool includes(int column, int row) const { return empty() || (*this)(column, row) != 0; }
  /// Whether the mask selects the sample at this row-major index.
  bool includes(std::size_t sample) const { return empty() || data()[sample] != 0; }
};

}  // namespace surf
