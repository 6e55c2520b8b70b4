// SPDX-License-Identifier: GPL-3.0-or-later
#include "max_plus.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <numeric>

#include "max_plus_kernel.h"
#include "surf/core/parallel.h"

namespace surf::max_plus {
namespace {

/// Ranks the places of a line by their distance from `apex`; of two places at the same distance,
/// the larger index comes first. b is rotated, so ties go to the lower and left sample of the
/// original.
std::vector<std::int32_t> ranks(int count, int apex, std::vector<int>& place_of_rank) {
  place_of_rank.resize(count);
  std::iota(place_of_rank.begin(), place_of_rank.end(), 0);
  std::sort(place_of_rank.begin(), place_of_rank.end(), [&](int p, int q) {
    const int dp = std::abs(p - apex), dq = std::abs(q - apex);
    return dp != dq ? dp < dq : p > q;
  });
  std::vector<std::int32_t> rank(count);
  for (int r = 0; r < count; ++r) rank[place_of_rank[r]] = r;
  return rank;
}

void bound_lines(Kernel& kernel) {
  const int lines = kernel.height + block_rows - 1;
  for (int l = 0; l < lines; ++l) {
    Quanta line_max = 2 * unknown;
    for (int c = 0; c < kernel.chunks; ++c) {
      const Quanta* const line = kernel.line(l);
      const Quanta m = *std::max_element(line + kernel.chunk_begin[c] * block_rows,
                                         line + kernel.chunk_begin[c + 1] * block_rows);
      kernel.chunk_max.push_back(m);
      line_max = std::max(line_max, m);
    }
    kernel.line_max.push_back(line_max);
  }
  kernel.order.resize(lines);
  std::iota(kernel.order.begin(), kernel.order.end(), 0);
  std::stable_sort(kernel.order.begin(), kernel.order.end(),
                   [&](int p, int q) { return kernel.line_max[p] > kernel.line_max[q]; });
}

}  // namespace

Kernel make_kernel(const Grid<Quanta>& b, int apex_x, int apex_y) {
  Kernel k;
  k.width = b.width();
  k.height = b.height();
  k.chunks = (k.width + chunk_columns - 1) / chunk_columns;
  for (int c = 0; c <= k.chunks; ++c) k.chunk_begin.push_back(c * k.width / k.chunks);
  const int lines = k.height + block_rows - 1;
  k.lines.assign(static_cast<std::size_t>(lines) * k.width * block_rows, unknown);
  for (int l = 0; l < lines; ++l)
    for (int r = 0; r < block_rows; ++r) {
      const int row = l - r;
      if (row < 0 || row >= k.height) continue;
      for (int x = 0; x < k.width; ++x)
        k.lines[(static_cast<std::size_t>(l) * k.width + x) * block_rows + r] =
            b(k.width - 1 - x, k.height - 1 - row);
    }
  bound_lines(k);
  k.row_rank = ranks(k.height, k.height - 1 - apex_y, k.row_of_rank);
  k.column_rank = ranks(k.width, k.width - 1 - apex_x, k.column_of_rank);
  return k;
}

namespace {

/// The maximum of z[begin, begin + count) for many windows, from two overlapping windows whose
/// length is a power of two.
class RangeMax {
 public:
  RangeMax(std::size_t length, std::size_t longest) : levels_(std::bit_width(longest)) {
    for (auto& level : levels_) level.resize(length);
  }
  void set(const Quanta* z) {
    const std::size_t length = levels_[0].size();
    std::copy(z, z + length, levels_[0].begin());
    for (std::size_t n = 1; n < levels_.size(); ++n) {
      const std::size_t step = std::size_t{1} << (n - 1);
      for (std::size_t i = 0; i + 2 * step <= length; ++i)
        levels_[n][i] = std::max(levels_[n - 1][i], levels_[n - 1][i + step]);
    }
  }
  Quanta operator()(std::size_t begin, std::size_t count) const {
    const std::size_t n = std::bit_width(count) - 1;
    return std::max(levels_[n][begin], levels_[n][begin + count - (std::size_t{1} << n)]);
  }

 private:
  std::vector<std::vector<Quanta>> levels_;
};

}  // namespace

Padded make_padded(const Grid<Quanta>& a, const Kernel& b, int apex_x, int apex_y, int lanes) {
  Padded p;
  p.block_width = lanes * block_vectors;
  p.blocks = (a.width() + p.block_width - 1) / p.block_width;
  p.stride = static_cast<std::ptrdiff_t>(p.blocks) * p.block_width + b.width - 1;
  const int strips = (a.height() + block_rows - 1) / block_rows;
  p.rows = static_cast<std::ptrdiff_t>(strips) * block_rows + b.height - 1;
  p.z.assign(static_cast<std::size_t>(p.stride * p.rows), unknown);
  const std::ptrdiff_t left = b.width - 1 - apex_x, below = b.height - 1 - apex_y;
  for (int y = 0; y < a.height(); ++y)
    std::copy_n(&a(0, y), a.width(), p.z.data() + (y + below) * p.stride + left);

  const std::size_t wide = static_cast<std::size_t>(p.blocks) * p.block_width;
  p.begin_outside.assign(wide, 1);
  p.begin_inside = p.begin_outside;
  std::fill_n(p.begin_inside.begin(), a.width(), lowest - 1);

  RangeMax largest(p.stride, p.block_width + b.width - 1);
  p.line_max.reserve(p.rows * p.blocks);
  p.chunk_max.reserve(p.rows * p.blocks * b.chunks);
  for (std::ptrdiff_t y = 0; y < p.rows; ++y) {
    largest.set(p.row(y));
    for (int block = 0; block < p.blocks; ++block) {
      const std::size_t x = static_cast<std::size_t>(block) * p.block_width;
      p.line_max.push_back(largest(x, p.block_width + b.width - 1));
      for (int c = 0; c < b.chunks; ++c)
        p.chunk_max.push_back(largest(x + b.chunk_begin[c],
                                      p.block_width + b.chunk_begin[c + 1] - b.chunk_begin[c] - 1));
    }
  }
  return p;
}

void convolve(const Grid<Quanta>& a, const Grid<Quanta>& b, int apex_x, int apex_y, int threads,
              Grid<Quanta>& sum, Grid<std::int32_t>* contact, const Watch& watch) {
  const Kernel kernel = make_kernel(b, apex_x, apex_y);
  const Padded padded = make_padded(a, kernel, apex_x, apex_y, strips().lanes);
  const StripFunction make_strip = contact ? strips().with_contact : strips().plain;
  const int width = a.width(), height = a.height();
  sum = Grid<Quanta>(width, height, unknown);
  if (contact) *contact = Grid<std::int32_t>(width, height, -1);

  threads = resolve_threads(threads);
  const std::size_t wide = static_cast<std::size_t>(padded.blocks) * padded.block_width;
  std::vector<std::vector<Quanta>> scratch(threads, std::vector<Quanta>(3 * block_rows * wide));
  const std::size_t units = (static_cast<std::size_t>(height) + block_rows - 1) / block_rows;
  parallel_for(
      units, threads,
      [&](std::size_t unit_of_work, int worker) {
        const int y = static_cast<int>(unit_of_work) * block_rows;
        Quanta* const space = scratch[worker].data();
        Strip strip;
        for (int r = 0; r < block_rows; ++r) {
          strip.sum[r] = space + r * wide;
          strip.rank[r] = space + (block_rows + r) * wide;
        }
        std::int32_t* const columns = space + 2 * block_rows * wide;
        make_strip(kernel, padded, y, width, height, strip, columns);
        for (int r = 0; r < block_rows && y + r < height; ++r)
          for (int x = 0; x < width; ++x) {
            const bool known = strip.sum[r][x] >= lowest;
            sum(x, y + r) = known ? strip.sum[r][x] : unknown;
            if (!contact || !known) continue;
            const int i = kernel.width - 1 - kernel.column_of_rank[columns[r * width + x]];
            const int j = kernel.height - 1 - kernel.row_of_rank[strip.rank[r][x]];
            (*contact)(x, y + r) = i + j * kernel.width;
          }
      },
      watch);
}

}  // namespace surf::max_plus
