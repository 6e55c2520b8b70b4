// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact_squares.h"

#include <algorithm>
#include <limits>

#include "contact_squares_found.h"
#include "max_plus_kernel.h"
#include "surf/core/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/contact_squares.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::max_plus::HWY_NAMESPACE {

typedef Quanta V [[gnu::vector_size(32)]];
constexpr int lanes_of_v = 8;

HWY_INLINE void load(V& v, const Quanta* p) { __builtin_memcpy(&v, p, sizeof v); }
HWY_INLINE void store(Quanta* p, const V& v) { __builtin_memcpy(p, &v, sizeof v); }

void find_columns(const Quanta* a, const Quanta* b, int begin, int end, int width,
                  const Quanta* least, Found& f) {
  for (int i = 0; i < block; i += lanes_of_v) {
    V asked, in_line, from_end, from_begin;
    load(asked, least + i);
    load(in_line, f.in_line.data() + i);
    load(from_end, f.from_end.data() + i);
    load(from_begin, f.from_begin.data() + i);
    for (int k = begin; k < end; ++k) {
      V sum;
      load(sum, a + k + i);
      sum += b[k * block_rows];
      const V touches = sum >= asked;
      const V to_end = touches & (width - k), to_begin = touches & (k + 1);
      in_line |= touches;
      from_end = to_end > from_end ? to_end : from_end;
      from_begin = to_begin > from_begin ? to_begin : from_begin;
    }
    store(f.in_line.data() + i, in_line);
    store(f.from_end.data() + i, from_end);
    store(f.from_begin.data() + i, from_begin);
  }
}

}  // namespace surf::max_plus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf::max_plus {
namespace {

HWY_EXPORT(find_columns);

constexpr int far = std::numeric_limits<int>::max();

Found find(const Kernel& b, const Padded& a, int row, int column_block, const Quanta* least) {
  Found f;
  f.from_end.fill(0);
  f.from_begin.fill(0);
  f.l0.fill(far);
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
      HWY_DYNAMIC_DISPATCH(find_columns)
      (a.row(row + l) + column_block * block, b.line(l), b.chunk_begin[c], b.chunk_begin[c + 1],
       b.width, least, f);
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
                     const Grid<Quanta>& least, int threads, const Watch& watch) {
  const Kernel kernel = make_kernel(b, apex_x, apex_y);
  const Padded padded = make_padded(a, kernel, apex_x, apex_y, block / block_vectors);
  const int width = a.width(), left = b.width() - 1 - apex_x, below = b.height() - 1 - apex_y;
  Grid<Touch> out(width, a.height());
  parallel_for(
      static_cast<std::size_t>(a.height()), threads,
      [&](std::size_t unit, int) {
        const int y = static_cast<int>(unit);
        std::array<Quanta, block> asked;
        for (int n = 0; n < padded.blocks; ++n) {
          for (int i = 0; i < block; ++i) {
            const int x = n * block + i;
            asked[i] = x < width && least(x, y) != unknown ? least(x, y) : far;
          }
          const Found f = find(kernel, padded, y, n, asked.data());
          for (int i = 0; i < block && n * block + i < width; ++i) {
            if (f.from_begin[i] == 0) continue;
            const int x = n * block + i - left;
            out(n * block + i, y) = {x + b.width() - f.from_end[i], y - below + f.l0[i],
                                     x + f.from_begin[i] - 1, y - below + f.l1[i]};
          }
        }
      },
      watch);
  return out;
}

}  // namespace surf::max_plus
#endif
