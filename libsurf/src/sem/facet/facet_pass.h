// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "core/aligned.h"
#include "facet_operations.h"
#include "surf/core/edge.h"
#include "surf/core/grid.h"
#include "surf/sem/filter_bank.h"

namespace surf::facet {

/// Pixels that are fitted together: at most `columns` wide; columns beyond the width are ignored.
struct Block {
  int x = 0, y = 0;
  int width = 0, rows = 0;
};

/// Fits of the cubic facet model in several neighbourhoods, as separable passes over blocks of
/// pixels that stay in the cache. Heights are converted to T relative to a height of the block, so
/// that adding a constant changes nothing, and float is precise enough far above zero. Fields may
/// be smaller than the neighbourhoods. The division into blocks depends only on the vector unit.
template <class T>
class FacetPass {
 public:
  /// Throws InvalidInput for scales out of range.
  FacetPass(const std::vector<FacetScale>& scales, double pitch_x_nm, double pitch_y_nm);

  struct Kernel {
    int radius;
    std::vector<Tap<T>> across, along;
    Scaling<T> scaling;
    double slope_noise, curvature_noise;  ///< sums of the magnitudes of all factors
  };
  const Kernel& kernel(int scale) const { return kernels_[scale]; }
  int radius() const { return radius_; }  ///< the largest

  int scales() const { return static_cast<int>(kernels_.size()); }
  int columns() const { return loops_->columns; }
  const Operations<T>& loops() const { return *loops_; }
  /// Blocks from left to right, then upwards: successive blocks use the same heights.
  std::vector<Block> blocks(int width, int height) const;

  /// A worker's memory: the heights around a block, and workspace for its fits. It can be reused
  /// for any block.
  struct Scratch {
    Block block;
    int radius = 0;
    AlignedVector<T> tile, moments, coefficients;
    std::vector<int> rows, index, tile_rows;
  };

  /// Loads the heights around a block for fits at all scales, or at one. `z_nm` must be finite.
  void load(const Grid<double>& z_nm, Edge edge, const Block& block, Scratch& scratch) const;
  void load(const Grid<double>& z_nm, Edge edge, const Block& block, Scratch& scratch,
            int scale) const;

  /// The coefficients K2 to K6 of a scale at the pixels of the loaded block, row by row as in
  /// `Operations`. Valid until the next call.
  const T* fit(int scale, Scratch& scratch) const;

  /// The slopes and curvatures that rounding alone gives a plane at the heights of the loaded
  /// block.
  Floors<T> floors(int scale, const Scratch& scratch) const;

 private:
  void list_rows(int height, Edge edge, Scratch& scratch) const;
  void fill_tile(const Grid<double>& z_nm, Edge edge, Scratch& scratch) const;

  std::vector<Kernel> kernels_;
  int radius_ = 0;
  const Operations<T>* loops_;
};

extern template class FacetPass<float>;
extern template class FacetPass<double>;

}  // namespace surf::facet
