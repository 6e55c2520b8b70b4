// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "max_plus.h"

namespace surf::max_plus {

/// Rows of the result that are made together, and vectors of each: they stay in registers, and each
/// vector loaded from `a` serves all the rows.
inline constexpr int block_rows = 2;
inline constexpr int block_vectors = 4;

/// Columns of b whose contribution is bounded, and left out, together.
inline constexpr int chunk_columns = 8;

/// b turned by 180 degrees, so that sum(x, y) = max over (k, l) of a(x + k, y + l) + b(k, l) with
/// `a` padded, and laid out as the kernel reads it. Line l holds b's row l for the first row of a
/// block and its row l - 1 for the second.
struct Kernel {
  int width = 0, height = 0;
  int chunks = 0;                 ///< per line
  std::vector<int> chunk_begin;   ///< columns; chunks + 1
  std::vector<Quanta> lines;      ///< (height + block_rows - 1) x width x block_rows
  std::vector<Quanta> line_max;   ///< per line
  std::vector<Quanta> chunk_max;  ///< per line and chunk
  std::vector<int> order;         ///< of lines: those first that reach highest
  std::vector<std::int32_t> row_rank, column_rank;  ///< of ties; turned as b is
  std::vector<int> row_of_rank, column_of_rank;     ///< back
  const Quanta* line(int l) const {
    return lines.data() + static_cast<std::ptrdiff_t>(l) * width * block_rows;
  }
};

/// `a` with unknown samples around it, and bounds of what it holds.
struct Padded {
  int block_width = 0;  ///< columns of the result in a block
  int blocks = 0;       ///< across
  std::ptrdiff_t stride = 0, rows = 0;
  std::vector<Quanta> z;
  std::vector<Quanta> line_max;   ///< per row and block: over all that a line of b meets
  std::vector<Quanta> chunk_max;  ///< per row, block and chunk
  const Quanta* row(std::ptrdiff_t y) const { return z.data() + y * stride; }

  /// What the maxima of a row of the result begin with. Where no result is wanted it is higher than
  /// all that can come, so that it keeps nothing from being left out.
  std::vector<Quanta> begin_inside, begin_outside;
  const Quanta* begin(bool inside) const {
    return inside ? begin_inside.data() : begin_outside.data();
  }
};

Kernel make_kernel(const Grid<Quanta>& b, int apex_x, int apex_y);
Padded make_padded(const Grid<Quanta>& a, const Kernel& b, int apex_x, int apex_y, Unit unit);

/// A pair of rows of the result, `block_width * blocks` wide, and the rank of the row of b that
/// gave it.
struct Strip {
  Quanta* sum[block_rows];
  std::int32_t* rank[block_rows];  ///< null without contacts
};

/// Result rows y and y + 1. The result's columns from `width` on and rows from `height` on do not
/// count.
using StripFunction = void (*)(const Kernel&, const Padded&, int y, int width, int height,
                               const Strip&, std::int32_t* column_rank);

StripFunction strip_function(Unit unit, bool with_contact);
int lanes(Unit unit);     ///< heights in a vector
Unit resolve(Unit unit);  ///< never `best`, always available

// The rest is compiled once for each vector unit. Everything is inlined into functions that are
// compiled for it, and nothing of the standard library is called.
#define SEMSURF_INLINE [[gnu::always_inline]] inline

template <int Bytes>
struct Vectors {
  typedef Quanta V [[gnu::vector_size(Bytes)]];
  static constexpr int count = Bytes / 4;
};

template <class V>
SEMSURF_INLINE void load(V& v, const Quanta* p) {
  __builtin_memcpy(&v, p, sizeof v);
}

/// Keeps GCC from loading v a second time where it is used twice: loads are what is short. Clang
/// does not allow it for vectors that the file's own target lacks.
template <class V>
SEMSURF_INLINE void keep([[maybe_unused]] V& v) {
#if defined(__x86_64__) && !defined(__clang__)
  asm("" : "+v"(v));
#endif
}

template <class V>
SEMSURF_INLINE void store(Quanta* p, const V& v) {
  __builtin_memcpy(p, &v, sizeof v);
}

template <class V>
SEMSURF_INLINE Quanta smallest(const V (&acc)[block_rows][block_vectors]) {
  V least = acc[0][0];
  for (int r = 0; r < block_rows; ++r)
    for (int c = 0; c < block_vectors; ++c) least = acc[r][c] < least ? acc[r][c] : least;
  Quanta m = least[0];
  for (int i = 1; i < static_cast<int>(sizeof(V) / 4); ++i) m = least[i] < m ? least[i] : m;
  return m;
}

/// Columns [begin, end) of a line of b, against the block that begins at `a`.
template <class V>
SEMSURF_INLINE void add_columns(const Quanta* a, const Quanta* b, int begin, int end,
                                V (&acc)[block_rows][block_vectors]) {
  constexpr int n = sizeof(V) / 4;
  for (int k = begin; k < end; ++k) {
    const V b0 = V{} + b[block_rows * k], b1 = V{} + b[block_rows * k + 1];
    for (int c = 0; c < block_vectors; ++c) {
      V s;
      load(s, a + k + c * n);
      keep(s);
      const V s0 = s + b0, s1 = s + b1;
      acc[0][c] = s0 > acc[0][c] ? s0 : acc[0][c];
      acc[1][c] = s1 > acc[1][c] ? s1 : acc[1][c];
    }
  }
}

/// A line of b against a block, leaving out what cannot exceed `floor`.
template <class V>
SEMSURF_INLINE void add_line(const Kernel& b, const Quanta* a, const Quanta* a_max, int line,
                             Quanta floor, V (&acc)[block_rows][block_vectors]) {
  const Quanta* b_max = b.chunk_max.data() + static_cast<std::ptrdiff_t>(line) * b.chunks;
  const Quanta* samples = b.line(line);
  for (int c = 0; c < b.chunks; ++c)
    if (a_max[c] + b_max[c] > floor)
      add_columns<V>(a, samples, b.chunk_begin[c], b.chunk_begin[c + 1], acc);
}

template <int Bytes>
SEMSURF_INLINE void strip(const Kernel& b, const Padded& a, int y, int height, const Strip& out) {
  using V = typename Vectors<Bytes>::V;
  constexpr int n = Vectors<Bytes>::count;
  for (int block = 0; block < a.blocks; ++block) {
    const int x = block * a.block_width;
    V acc[block_rows][block_vectors];
    for (int r = 0; r < block_rows; ++r)
      for (int c = 0; c < block_vectors; ++c) load(acc[r][c], a.begin(y + r < height) + x + c * n);
    Quanta floor = lowest - 1;
    int done = 0;
    for (const int line : b.order) {
      const std::ptrdiff_t at = (y + line) * static_cast<std::ptrdiff_t>(a.blocks) + block;
      if (a.line_max[at] + b.line_max[line] <= floor) continue;
      add_line<V>(b, a.row(y + line) + x, a.chunk_max.data() + at * b.chunks, line, floor, acc);
      if (++done <= 2 || done % 4 == 0) floor = smallest<V>(acc);
    }
    for (int r = 0; r < block_rows; ++r)
      for (int c = 0; c < block_vectors; ++c) store(out.sum[r] + x + c * n, acc[r][c]);
  }
}

/// The column of row `b_row` of b that gives `sum` at the place `a` looks from, as its rank.
SEMSURF_INLINE std::int32_t find_column(const Quanta* a, const Quanta* b_row,
                                        const std::int32_t* rank, int width, Quanta sum) {
  std::int32_t least = width;
  for (int k = 0; k < width; ++k) {
    const std::int32_t here = a[k] + b_row[k * block_rows] == sum ? rank[k] : width;
    least = here < least ? here : least;
  }
  return least;
}

template <int Bytes>
SEMSURF_INLINE void strip_with_contact(const Kernel& b, const Padded& a, int y, int width,
                                       int height, const Strip& out, std::int32_t* column_rank) {
  using V = typename Vectors<Bytes>::V;
  constexpr int n = Vectors<Bytes>::count;
  for (int block = 0; block < a.blocks; ++block) {
    const int x = block * a.block_width;
    V best[block_rows][block_vectors] = {}, rank[block_rows][block_vectors] = {};
    for (int r = 0; r < block_rows; ++r)
      for (int c = 0; c < block_vectors; ++c) {
        rank[r][c] = V{} + b.height;
        load(best[r][c], a.begin(y + r < height) + x + c * n);
      }
    Quanta floor = lowest - 1;
    int done = 0;
    for (const int line : b.order) {
      const std::ptrdiff_t at = (y + line) * static_cast<std::ptrdiff_t>(a.blocks) + block;
      // What just reaches the floor may win a tie.
      const Quanta below = floor < lowest ? floor : floor - 1;
      if (a.line_max[at] + b.line_max[line] <= below) continue;
      V acc[block_rows][block_vectors];
      for (auto& row : acc)
        for (V& v : row) v = V{} + (lowest - 1);
      add_line<V>(b, a.row(y + line) + x, a.chunk_max.data() + at * b.chunks, line, below, acc);
      for (int r = 0; r < block_rows; ++r) {
        const int row = line - r;
        if (row < 0 || row >= b.height) continue;
        const V mine = V{} + b.row_rank[row];
        for (int c = 0; c < block_vectors; ++c) {
          const V higher = acc[r][c] > best[r][c];
          const V tie = (acc[r][c] == best[r][c]) & (mine < rank[r][c]);
          rank[r][c] = (higher | tie) ? mine : rank[r][c];
          best[r][c] = higher ? acc[r][c] : best[r][c];
        }
      }
      if (++done <= 2 || done % 4 == 0) floor = smallest<V>(best);
    }
    for (int r = 0; r < block_rows; ++r)
      for (int c = 0; c < block_vectors; ++c) {
        store(out.sum[r] + x + c * n, best[r][c]);
        store(out.rank[r] + x + c * n, rank[r][c]);
      }
  }
  for (int r = 0; r < block_rows && y + r < height; ++r)
    for (int x = 0; x < width; ++x) {
      const Quanta sum = out.sum[r][x];
      if (sum < lowest) continue;
      const int row = b.row_of_rank[out.rank[r][x]];
      column_rank[static_cast<std::ptrdiff_t>(r) * width + x] =
          find_column(a.row(y + r + row) + x, b.line(row), b.column_rank.data(), b.width, sum);
    }
}

}  // namespace surf::max_plus
