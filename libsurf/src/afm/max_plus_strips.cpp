// SPDX-License-Identifier: GPL-3.0-or-later
#include "max_plus_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "afm/max_plus_strips.cpp"
#include "core/each_target.h"

HWY_BEFORE_NAMESPACE();
namespace surf::max_plus::HWY_NAMESPACE {

typedef Quanta V [[gnu::vector_size(SEMSURF_VECTOR_BYTES)]];
constexpr int count_of_v = SEMSURF_VECTOR_BYTES / 4;

HWY_INLINE void load(V& v, const Quanta* p) { __builtin_memcpy(&v, p, sizeof v); }

/// Keeps GCC from loading v twice where it is used twice, because loads are the bottleneck. Clang
/// does not allow this for vectors that the file's own target lacks.
HWY_INLINE void keep([[maybe_unused]] V& v) {
#if defined(__x86_64__) && !defined(__clang__)
  asm("" : "+v"(v));
#endif
}

HWY_INLINE void store(Quanta* p, const V& v) { __builtin_memcpy(p, &v, sizeof v); }

HWY_INLINE Quanta smallest(const V (&acc)[block_rows][block_vectors]) {
  V least = acc[0][0];
  for (int r = 0; r < block_rows; ++r)
    for (int c = 0; c < block_vectors; ++c) least = acc[r][c] < least ? acc[r][c] : least;
  Quanta m = least[0];
  for (int i = 1; i < count_of_v; ++i) m = least[i] < m ? least[i] : m;
  return m;
}

/// Adds columns [begin, end) of a line of b, for the block that begins at `a`.
HWY_INLINE void add_columns(const Quanta* a, const Quanta* b, int begin, int end,
                            V (&acc)[block_rows][block_vectors]) {
  constexpr int n = count_of_v;
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

/// Adds a line of b to a block, and skips what cannot exceed `floor`.
HWY_INLINE void add_line(const Kernel& b, const Quanta* a, const Quanta* a_max, int line,
                         Quanta floor, V (&acc)[block_rows][block_vectors]) {
  const Quanta* b_max = b.chunk_max.data() + static_cast<std::ptrdiff_t>(line) * b.chunks;
  const Quanta* samples = b.line(line);
  for (int c = 0; c < b.chunks; ++c)
    if (a_max[c] + b_max[c] > floor)
      add_columns(a, samples, b.chunk_begin[c], b.chunk_begin[c + 1], acc);
}

void strip(const Kernel& b, const Padded& a, int y, int, int height, const Strip& out,
           std::int32_t*) {
  constexpr int n = count_of_v;
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
      add_line(b, a.row(y + line) + x, a.chunk_max.data() + at * b.chunks, line, floor, acc);
      if (++done <= 2 || done % 4 == 0) floor = smallest(acc);
    }
    for (int r = 0; r < block_rows; ++r)
      for (int c = 0; c < block_vectors; ++c) store(out.sum[r] + x + c * n, acc[r][c]);
  }
}

/// The rank of the column in row `b_row` of b that gives `sum` at `a`.
HWY_INLINE std::int32_t find_column(const Quanta* a, const Quanta* b_row, const std::int32_t* rank,
                                    int width, Quanta sum) {
  std::int32_t least = width;
  for (int k = 0; k < width; ++k) {
    const std::int32_t here = a[k] + b_row[k * block_rows] == sum ? rank[k] : width;
    least = here < least ? here : least;
  }
  return least;
}

void strip_with_contact(const Kernel& b, const Padded& a, int y, int width, int height,
                        const Strip& out, std::int32_t* column_rank) {
  constexpr int n = count_of_v;
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
      // A sum equal to the floor may still win a tie.
      const Quanta below = floor < lowest ? floor : floor - 1;
      if (a.line_max[at] + b.line_max[line] <= below) continue;
      V acc[block_rows][block_vectors];
      for (auto& row : acc)
        for (V& v : row) v = V{} + (lowest - 1);
      add_line(b, a.row(y + line) + x, a.chunk_max.data() + at * b.chunks, line, below, acc);
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
      if (++done <= 2 || done % 4 == 0) floor = smallest(best);
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

const Strips* all() {
  static constexpr Strips strips{count_of_v, strip, strip_with_contact};
  return &strips;
}

}  // namespace surf::max_plus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf::max_plus {

HWY_EXPORT(all);
const Strips& strips() { return *HWY_DYNAMIC_DISPATCH(all)(); }

}  // namespace surf::max_plus
#endif
