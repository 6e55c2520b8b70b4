// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>

#include "surf/core/grid.h"

namespace surf {

/// Which samples of a grid count: those that are not 0. A mask without samples counts all of them;
/// any other has the size of the grid that it belongs to.
class Mask : public Grid<unsigned char> {
 public:
  using Grid::Grid;
  explicit Mask(Grid<unsigned char> grid) : Grid(std::move(grid)) {}

  /// Whether the sample counts.
  bool includes(int column, int row) const { return empty() || (*this)(column, row) != 0; }
  /// Whether the sample of that place in row-major order counts.
  bool includes(std::size_t sample) const { return empty() || data()[sample] != 0; }
};

}  // namespace surf
