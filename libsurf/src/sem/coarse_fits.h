// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "facet_pass.h"
#include "surf/core/grid.h"
#include "surf/sem/filter_bank.h"

namespace surf::facet {

/// How often a neighbourhood's heights are halved before its fit (thesis, 6.8.4): as often as leaves its
/// sigma at 0.84 coarse samples or more, so that the Gaussian is still sampled; never for uniform weights.
int halvings(const FacetScale& scale);

/// Fits of wide neighbourhoods on a pyramid of coarser heights. Each level is the one below, smoothed by
/// (1, 2, 1) / 4 along both axes, at every other sample; coefficients between its samples are
/// interpolated linearly. The field is continued as its edge says as far as any of this reaches.
template <class T>
class CoarseFits {
 public:
  /// Of those scales that are halved at all. Only `load` makes fits.
  CoarseFits(const std::vector<FacetScale>& scales, double pitch_x_nm, double pitch_y_nm);

  bool has(int scale) const { return fits_[scale].level > 0; }
  void load(const Grid<double>& z_nm, Edge edge, int threads);

  /// A scale's coefficients at a block's pixels, row by row, `columns` apart; 0 beyond its width.
  void at(int scale, const Block& block, int columns, T* coefficients) const;
  const Floors<T>& floors(int scale) const { return fits_[scale].floors; }

  /// Weights of the coefficients at all pixels of the field: planes K2 to K6, each row by row.
  using Planes = AlignedVector<T>;
  /// The transpose of load and `at` for weights[scale], empty where there are none: adds to `gradient`, times
  /// `unit`.
  void transpose(std::vector<Planes>& weights, Edge edge, int threads, double unit, Grid<double>& gradient) const;

 private:
  struct Fit {
    int level = 0;
    std::vector<FacetPass<T>> pass;   ///< one, of the halved scale
    Planes planes;
    Floors<T> floors;
  };
  /// Where a pixel lies between a level's samples.
  struct Between {
    int sample;
    T fraction;
  };
  Between between(int pixel, int level) const;

  std::vector<Fit> fits_;
  int levels_ = 0, margin_ = 0;
  std::vector<int> widths_, heights_;   ///< of each level
};

extern template class CoarseFits<float>;
extern template class CoarseFits<double>;

}  // namespace surf::facet
