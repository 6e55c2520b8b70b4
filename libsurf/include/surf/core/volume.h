// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "surf/core/vec3.h"

namespace surf {

/// A quantity in the cells of a regular spatial grid. Cell (i, j, k) has the index i + nx (j + ny
/// k) and extends from lower_nm + (i, j, k) cell_nm to lower_nm + (i + 1, j + 1, k + 1) cell_nm.
struct Volume {
  std::string name;  ///< of the quantity
  std::string unit;
  std::array<int, 3> cells{0, 0, 0};  ///< along x, y, z, each >= 1
  Vec3 lower_nm;                      ///< lower corner of cell (0, 0, 0)
  Vec3 cell_nm{1, 1, 1};              ///< edges of a cell, > 0
  std::vector<double> values;
  std::map<std::string, std::string> metadata;  ///< as in `Image`

  std::size_t size() const {
    return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
           static_cast<std::size_t>(cells[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(cells[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(k));
  }
};

}  // namespace surf
