// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "facet_pass.h"

namespace surf::facet {

/// Pixels whose derivatives are made at once, in memory that stays in the cache.
struct Tile {
  Block area;
  int strips = 0;             ///< blocks beside one another
  std::vector<Block> blocks;  ///< those of FacetPass::blocks in the area, in their order
};

/// The transpose of the fits of a FacetPass, tile by tile. Its memory depends on the size of tiles,
/// not on that of the field. The division into tiles depends only on the field's size and on the
/// vector unit: sums of single precision are rounded for each tile.
template <class T>
class TransposedFits {
 public:
  /// Refers to `pass`.
  TransposedFits(const FacetPass<T>& pass, Edge edge, int threads);

  std::vector<Tile> tiles(int width, int height) const;

  /// Writes, row by row, the weights of a scale's coefficients at the pixels of a block, which is
  /// number `index` of its tile. Called from several threads.
  using Source =
      std::function<void(int worker, int scale, const Block& block, std::size_t index, T* weights)>;

  /// Adds to `gradient` (of the size of the heights) `unit` times the derivative by the heights of
  /// the sum of weight times coefficient over a tile's pixels, all coefficients and scales.
  void add(const Tile& tile, const Source& source, double unit, Grid<double>& gradient);

  /// The same for all tiles of a field.
  void add_all(const Source& source, double unit, Grid<double>& gradient);

 private:
  using Kernel = typename FacetPass<T>::Kernel;
  struct Slots {
    int first, end;
  };
  void place(const Tile& tile, int height);
  int slot(int y) const;
  Slots slots(const Kernel& kernel) const;
  T* moments_at(int strip, int slot);
  void along(const Kernel& kernel, int strip, const T* weights);
  void across(const Kernel& kernel, int group, AlignedVector<T>& turned);
  void put(int group, bool inside, double unit, AlignedVector<T>& rows, Grid<double>& gradient);

  const FacetPass<T>& pass_;
  Edge edge_;
  int threads_, wide_;

  // Of the tile at hand. Rows of heights have slots from `low_` on. Rows outside the field share
  // the slots of the rows that continue it, where the tile has those.
  Block area_;
  int strips_ = 0, height_ = 0, low_ = 0, count_ = 0, groups_ = 0;
  std::ptrdiff_t sum_size_ = 0;
  AlignedVector<T> moments_;  ///< weights, [group of slots][strip][moment][slot][column]
  AlignedVector<T> sums_;     ///< by heights, [group of slots][column][slot]
  std::vector<AlignedVector<T>> weights_, turned_;  ///< [worker]
};

extern template class TransposedFits<float>;
extern template class TransposedFits<double>;

}  // namespace surf::facet
