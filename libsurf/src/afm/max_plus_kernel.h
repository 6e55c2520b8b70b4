// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "max_plus.h"

namespace surf::max_plus {

/// Rows of the result that are computed together, and vectors per row. They stay in registers, and
/// each vector that is loaded from `a` serves all rows.
inline constexpr int block_rows = 2;
inline constexpr int block_vectors = 4;

/// Columns of b whose contribution is bounded, and skipped, together.
inline constexpr int chunk_columns = 8;

/// b rotated by 180 degrees, in the layout that the kernel reads: sum(x, y) = max over (k, l) of
/// a(x + k, y + l) + b(k, l) with the padded `a`. Line l holds b's row l for the first row of a
/// block and b's row l - 1 for the second.
struct Kernel {
  int width = 0, height = 0;
  int chunks = 0;                 ///< per line
  std::vector<int> chunk_begin;   ///< columns; chunks + 1
  std::vector<Quanta> lines;      ///< (height + block_rows - 1) x width x block_rows
  std::vector<Quanta> line_max;   ///< per line
  std::vector<Quanta> chunk_max;  ///< per line and chunk
  std::vector<int> order;         ///< of lines, the one with the largest maximum first
  std::vector<std::int32_t> row_rank, column_rank;  ///< order among ties; rotated like b
  std::vector<int> row_of_rank, column_of_rank;     ///< inverse of the ranks
  const Quanta* line(int l) const {
    return lines.data() + static_cast<std::ptrdiff_t>(l) * width * block_rows;
  }
};

/// `a` with unknown samples around it, and upper bounds of its values.
struct Padded {
  int block_width = 0;  ///< columns of the result in a block
  int blocks = 0;       ///< across
  std::ptrdiff_t stride = 0, rows = 0;
  std::vector<Quanta> z;
  /// Per row and block: maximum over all samples that a line of b meets.
  std::vector<Quanta> line_max;
  std::vector<Quanta> chunk_max;  ///< per row, block and chunk
  const Quanta* row(std::ptrdiff_t y) const { return z.data() + y * stride; }

  /// Initial values of the maxima in a row of the result. Columns without a wanted result begin
  /// with a value above every possible sum, so that they never prevent skipping.
  std::vector<Quanta> begin_inside, begin_outside;
  const Quanta* begin(bool inside) const {
    return inside ? begin_inside.data() : begin_outside.data();
  }
};

Kernel make_kernel(const Grid<Quanta>& b, int apex_x, int apex_y);
Padded make_padded(const Grid<Quanta>& a, const Kernel& b, int apex_x, int apex_y, int lanes);

/// A pair of rows of the result, `block_width * blocks` wide, and the rank of the row of b that
/// gave each maximum.
struct Strip {
  Quanta* sum[block_rows];
  std::int32_t* rank[block_rows];  ///< null without contacts
};

/// Computes rows y and y + 1 of the result. Columns from `width` on and rows from `height` on are
/// not wanted.
using StripFunction = void (*)(const Kernel&, const Padded&, int y, int width, int height,
                               const Strip&, std::int32_t* column_rank);

/// The fastest strip functions that the processor supports.
struct Strips {
  int lanes;  ///< heights in a vector
  StripFunction plain, with_contact;
};
const Strips& strips();

}  // namespace surf::max_plus
