// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "facet_pass.h"
#include "surf/core/grid.h"
#include "surf/core/progress.h"
#include "surf/sem/filter_bank.h"

namespace surf::facet {

/// How often the resolution of a neighbourhood's heights is halved before its fit (thesis, 6.8.4):
/// as long as sigma stays at least 0.84 coarse samples, so that the Gaussian is still sampled;
/// never for uniform weights.
int halvings(const FacetScale& scale);

/// Fits of wide neighbourhoods on a pyramid of coarser heights. Each level consists of every other
/// sample of the level below, smoothed by (1, 2, 1) / 4 along both axes. Coefficients between
/// coarse samples are interpolated linearly. The field is continued by `edge` as far as necessary.
template <class T>
class CoarseFits {
 public:
  /// Handles those of the scales that are halved. Only `load` makes fits.
  CoarseFits(const std::vector<FacetScale>& scales, double pitch_x_nm, double pitch_y_nm);

  bool has(int scale) const { return fits_[scale].level > 0; }
  void load(const Grid<double>& z_nm, Edge edge, int threads, const Watch& watch);

  /// The coefficients of a scale at a block's pixels, row by row, `columns` (those of FacetPass)
  /// apart; 0 beyond the block's width.
  void at(int scale, const Block& block, int columns, AlignedVector<T>& memory,
          T* coefficients) const;
  const Floors<T>& floors(int scale) const { return fits_[scale].floors; }

  /// Writes, row by row, the weights of a scale's coefficients at the pixels of a column of pixels:
  /// a block of the field's full height. Called from several threads.
  using Source = std::function<void(int worker, int scale, const Block& column, T* weights)>;

  /// The transpose of `load` and `at` for all halved scales: adds `unit` times the result to
  /// `gradient`.
  void transpose(const Source& source, int columns, Edge edge, int threads, double unit,
                 Grid<double>& gradient) const;

 private:
  using Planes = AlignedVector<T>;
  struct Fit {
    int level = 0, radius = 0;
    std::vector<FacetPass<T>> pass;  ///< a single pass, of the halved scale
    int width = 0;                   ///< number of coarse columns
    Planes planes;                   ///< K2 to K6 row by row
    Floors<T> floors;
  };
  struct Range {
    int first, count;
  };
  struct Worth {
    int first, count;     ///< samples of the fit
    AlignedVector<T> of;  ///< [sample][column]
  };
  std::vector<int> continued(int count, Edge edge) const;
  Range range(const Fit& fit, int count) const;
  Range rows_of(const Fit& fit, const Block& block) const;
  Worth worth(const Fit& fit, const Block& block, int columns) const;
  void fit_level(const Grid<double>& z, int width, int height, int threads, const Watch& watch,
                 Fit& fit) const;
  void transpose_fit(int scale, const Source& source, int columns, int threads, double unit,
                     int width, int height, Grid<double>& level) const;

  std::vector<Fit> fits_;
  int levels_ = 0, margin_ = 0;
};

extern template class CoarseFits<float>;
extern template class CoarseFits<double>;

}  // namespace surf::facet
