// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_squares.h"

#include <algorithm>
#include <array>
#include <limits>

#include "max_plus_kernel.h"
#include "surf/core/parallel.h"

#ifdef __x86_64__
#define SEMSURF_CLONES [[gnu::target_clones("avx2", "default")]]
#else
#define SEMSURF_CLONES
#endif

namespace surf::max_plus {
namespace {

constexpr int block = 32;
constexpr int far = std::numeric_limits<int>::max();

/// Of the places of a block: the first and last columns and lines of the turned b that touch.
struct Found {
  std::array<int, block> k0, k1, l0, l1;
  std::array<int, block> in_line;
};

SEMSURF_CLONES void find_columns(const Quanta* a, const Quanta* b, int begin, int end, const Quanta* least,
                                 Found& f) {
  for (int k = begin; k < end; ++k)
    for (int i = 0; i < block; ++i) {
      const int touches = -static_cast<int>(a[k + i] + b[k * block_rows] >= least[i]);
      f.in_line[i] |= touches;
      f.k0[i] = std::min(f.k0[i], touches ? k : far);
      f.k1[i] = std::max(f.k1[i], touches ? k : -1);
    }
}

Found find(const Kernel& b, const Padded& a, int row, int column_block, const Quanta* least) {
  Found f;
  f.k0.fill(far);
  f.l0.fill(far);
  f.k1.fill(-1);
  f.l1.fill(-1);
  const Quanta lowest_asked = *std::min_element(least, least + block);
  if (lowest_asked == far) return f;
  for (int l = 0; l < b.height; ++l) {
    const std::ptrdiff_t at = (row + l) * static_cast<std::ptrdiff_t>(a.blocks) + column_block;
    if (a.line_max[at] + b.line_max[l] < lowest_asked) continue;
    f.in_line.fill(0);
    for (int c = 0; c < b.chunks; ++c) {
      const std::ptrdiff_t line = static_cast<std::ptrdiff_t>(l) * b.chunks;
      if (a.chunk_max[at * b.chunks + c] + b.chunk_max[line + c] < lowest_asked) continue;
      find_columns(a.row(row + l) + column_block * block, b.line(l), b.chunk_begin[c], b.chunk_begin[c + 1], least, f);
    }
    for (int i = 0; i < block; ++i) {
      if (!f.in_line[i]) continue;
      f.l0[i] = std::min(f.l0[i], l);
      f.l1[i] = l;
    }
  }
  return f;
}

}  // namespace

Grid<Touch> touching(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y,
                     const Grid<Quanta>& least, int threads) {
  const Kernel kernel = make_kernel(b, apex_x, apex_y);
  const Padded padded = make_padded(a, kernel, apex_x, apex_y, Unit::avx2);   // for its block's width alone
  const int width = a.width(), left = b.width() - 1 - apex_x, below = b.height() - 1 - apex_y;
  Grid<Touch> out(width, a.height());
  parallel_for(static_cast<std::size_t>(a.height()), threads, [&](std::size_t unit, int) {
    const int y = static_cast<int>(unit);
    std::array<Quanta, block> asked;
    for (int n = 0; n < padded.blocks; ++n) {
      for (int i = 0; i < block; ++i) {
        const int x = n * block + i;
        asked[i] = x < width && least(x, y) != unknown ? least(x, y) : far;
      }
      const Found f = find(kernel, padded, y, n, asked.data());
      for (int i = 0; i < block && n * block + i < width; ++i) {
        if (f.k1[i] < 0) continue;
        const int x = n * block + i - left;
        out(n * block + i, y) = {x + f.k0[i], y - below + f.l0[i], x + f.k1[i], y - below + f.l1[i]};
      }
    }
  });
  return out;
}

}  // namespace surf::max_plus
