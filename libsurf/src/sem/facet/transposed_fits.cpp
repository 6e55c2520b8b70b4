// SPDX-License-Identifier: GPL-3.0-or-later
#include "transposed_fits.h"

#include <algorithm>

#include "sem/model/border.h"
#include "surf/core/parallel.h"

namespace surf::facet {
namespace {

// Margins of the widest neighbourhood make a tile a sixth wider and higher; moments of a tile take
// 5 MB.
constexpr int most_columns = 512, most_rows = 512;

}  // namespace

template <class T>
TransposedFits<T>::TransposedFits(const FacetPass<T>& pass, Edge edge, int threads)
    : pass_(pass), edge_(edge), threads_(resolve_threads(threads)), wide_(pass.columns()),
      weights_(threads_), turned_(threads_) {}

template <class T>
std::vector<Tile> TransposedFits<T>::tiles(int width, int height) const {
  const std::vector<Block> blocks = pass_.blocks(width, height);
  const int strips = (width + wide_ - 1) / wide_, parts = static_cast<int>(blocks.size()) / strips;
  const int part_rows = blocks.front().rows;
  const int along = std::max(1, most_rows / std::max(part_rows, 1));
  const int across = (width + most_columns - 1) / most_columns;
  std::vector<Tile> tiles;
  for (int part = 0; part < parts; part += along)
    for (int i = 0; i < across; ++i) {
      const int first = strips * i / across, end = strips * (i + 1) / across;
      Tile& tile = tiles.emplace_back();
      tile.strips = end - first;
      for (int p = part; p < std::min(parts, part + along); ++p)
        for (int s = first; s < end; ++s)
          tile.blocks.push_back(blocks[static_cast<std::size_t>(p) * strips + s]);
      const Block &from = tile.blocks.front(), &to = tile.blocks.back();
      tile.area = {from.x, from.y, to.x + to.width - from.x, to.y + to.rows - from.y};
    }
  return tiles;
}

/// Decides which rows of heights have slots.
template <class T>
void TransposedFits<T>::place(const Tile& tile, int height) {
  area_ = tile.area;
  strips_ = tile.strips;
  height_ = height;
  const int radius = pass_.radius(), first = area_.y - radius, end = area_.y + area_.rows + radius;
  const int low = std::max(first, 0), high = std::min(end, height);
  const auto has = [&](int y) {
    const int row = border_sample(y, height, edge_);
    return row >= low && row < high;
  };
  low_ = low;
  for (int y = first; y < 0; ++y)
    if (!has(y)) low_ = first;
  int last = high;
  for (int y = height; y < end; ++y)
    if (!has(y)) last = end;
  count_ = last - low_;
  groups_ = (count_ + wide_ - 1) / wide_;
  const int columns = area_.width + 2 * radius;
  sum_size_ = std::ptrdiff_t{(columns + wide_) / wide_} * wide_ * wide_;
  moments_.resize(static_cast<std::size_t>(groups_) * strips_ * moments * wide_ * wide_);
  sums_.assign(static_cast<std::size_t>(groups_ * sum_size_), T(0));
}

template <class T>
int TransposedFits<T>::slot(int y) const {
  if (y >= 0 && y < height_) return y - low_;
  const int at = border_sample(y, height_, edge_) - low_;
  return at >= 0 && at < count_ ? at : y - low_;
}

/// The slots from the first to the last that hold weights of a scale's moments.
template <class T>
typename TransposedFits<T>::Slots TransposedFits<T>::slots(const Kernel& kernel) const {
  Slots used{area_.y - low_, area_.y + area_.rows - low_};
  for (int out = 1; out <= kernel.radius; ++out)
    for (const int y : {area_.y - out, area_.y + area_.rows - 1 + out}) {
      used.first = std::min(used.first, slot(y));
      used.end = std::max(used.end, slot(y) + 1);
    }
  return used;
}

template <class T>
T* TransposedFits<T>::moments_at(int strip, int slot) {
  const std::ptrdiff_t square = std::ptrdiff_t{wide_} * wide_;
  return moments_.data() + (std::ptrdiff_t{slot / wide_} * strips_ + strip) * moments * square +
         std::ptrdiff_t{slot % wide_} * wide_;
}

/// Computes weights of moments from weights of coefficients.
template <class T>
void TransposedFits<T>::along(const Kernel& kernel, int strip, const T* weights) {
  const int r = kernel.radius, rows = area_.rows;
  const std::ptrdiff_t row_size = static_cast<std::ptrdiff_t>(coefficients) * wide_;
  const std::ptrdiff_t plane = std::ptrdiff_t{wide_} * wide_;
  const Slots used = slots(kernel);
  const int inside = area_.y - low_;
  const auto clear = [&](int from, int to) {
    for (int s = from; s < to; ++s)
      for (int m = 0; m < moments; ++m) std::fill_n(moments_at(strip, s) + m * plane, wide_, T(0));
  };
  clear(used.first / wide_ * wide_, inside);
  clear(inside + rows, (used.end + wide_ - 1) / wide_ * wide_);
  std::vector<T*> places(rows + 2 * r);
  T** const to = places.data() + r;
  for (int y = -r; y < rows + r; ++y) to[y] = moments_at(strip, slot(area_.y + y));
  const Tap<T>* const taps = kernel.along.data();
  pass_.loops().along_transposed(weights, rows, taps, 1, r, false, to, plane);
  // Rows outside the tile have no taps nearer than the tile.
  for (int out = 1; out <= r; out += 2) {
    const int count = std::min(2, r + 1 - out);
    for (const int y : {1 - out - count, rows - 1 + out})
      pass_.loops().along_transposed(weights + y * row_size, count, taps, out, r, true, to + y,
                                     plane);
  }
}

/// Adds the contribution of some slots' weights of moments to the sums.
template <class T>
void TransposedFits<T>::across(const Kernel& kernel, int group, AlignedVector<T>& turned) {
  const int r = kernel.radius;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(moments) * wide_,
                       plane = std::ptrdiff_t{wide_} * wide_, before = 2 * r * stride,
                       columns = std::ptrdiff_t{strips_} * wide_;
  turned.resize(2 * before + (columns + 1) * stride);
  std::fill_n(turned.begin(), before, T(0));
  std::fill(turned.begin() + before + columns * stride, turned.end(), T(0));
  for (int strip = 0; strip < strips_; ++strip)
    for (int m = 0; m < moments; ++m)
      pass_.loops().turn(moments_at(strip, group * wide_) + m * plane, wide_, wide_, stride,
                         turned.data() + before + strip * wide_ * stride + m * wide_);
  pass_.loops().across_transposed(
      turned.data() + r * stride, area_.width + 2 * r, kernel.across.data(), r,
      sums_.data() + group * sum_size_ + std::ptrdiff_t{pass_.radius() - r} * wide_);
}

/// Adds the sums of a group's rows that lie in the field, or of those outside it.
template <class T>
void TransposedFits<T>::put(int group, bool inside, double unit, AlignedVector<T>& rows,
                            Grid<double>& gradient) {
  const int first = low_ + group * wide_, end = std::min(first + wide_, low_ + count_);
  const auto wanted = [&](int y) { return (y >= 0 && y < height_) == inside; };
  bool any = false;
  for (int y = first; y < end; ++y) any = any || wanted(y);
  if (!any) return;
  const int radius = pass_.radius(), columns = area_.width + 2 * radius;
  rows.resize(static_cast<std::size_t>(wide_) * wide_);
  const T* from = sums_.data() + group * sum_size_;
  for (int done = 0; done < columns; done += wide_, from += std::ptrdiff_t{wide_} * wide_) {
    pass_.loops().turn(from, wide_, wide_, wide_, rows.data());
    const int x = area_.x - radius + done, count = std::min(wide_, columns - done);
    for (int y = first; y < end; ++y) {
      if (!wanted(y)) continue;
      add_continued(rows.data() + static_cast<std::ptrdiff_t>(y - first) * wide_, count, x, unit,
                    edge_, &gradient(0, border_sample(y, height_, edge_)), gradient.width());
    }
  }
}

template <class T>
void TransposedFits<T>::add(const Tile& tile, const Source& source, double unit,
                            Grid<double>& gradient) {
  place(tile, gradient.height());
  const std::ptrdiff_t row_size = static_cast<std::ptrdiff_t>(coefficients) * wide_;
  for (int scale = 0; scale < pass_.scales(); ++scale) {
    const Kernel& kernel = pass_.kernel(scale);
    const std::ptrdiff_t outside = 2 * kernel.radius * row_size;
    parallel_for(strips_, threads_, [&](std::size_t strip, int w) {
      weights_[w].resize(static_cast<std::size_t>(area_.rows + 1) * row_size + 2 * outside);
      T* const inside = weights_[w].data() + outside;
      std::fill_n(weights_[w].begin(), outside, T(0));
      std::fill_n(inside + area_.rows * row_size, outside + row_size, T(0));
      for (std::size_t i = strip; i < tile.blocks.size(); i += strips_)
        source(w, scale, tile.blocks[i], i, inside + (tile.blocks[i].y - area_.y) * row_size);
      for (T* row = inside; row < inside + area_.rows * row_size; row += row_size)
        for (int x = 0; x < wide_; ++x) {
          row[3 * wide_ + x] *= kernel.scaling.k5;
          row[4 * wide_ + x] *= kernel.scaling.k6;
        }
      along(kernel, static_cast<int>(strip), inside);
    });
    const Slots used = slots(kernel);
    const int first = used.first / wide_, end = (used.end + wide_ - 1) / wide_;
    parallel_for(end - first, threads_, [&](std::size_t i, int w) {
      across(kernel, first + static_cast<int>(i), turned_[w]);
    });
  }
  parallel_for(groups_, threads_, [&](std::size_t group, int w) {
    put(static_cast<int>(group), true, unit, weights_[w], gradient);
  });
  // Several of the rows outside the field may continue the same row.
  for (int group = 0; group < groups_; ++group) put(group, false, unit, weights_[0], gradient);
}

template <class T>
void TransposedFits<T>::add_all(const Source& source, double unit, Grid<double>& gradient) {
  for (const Tile& tile : tiles(gradient.width(), gradient.height()))
    add(tile, source, unit, gradient);
}

template class TransposedFits<float>;
template class TransposedFits<double>;

}  // namespace surf::facet
