// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "coarse_fits.h"
#include "facet_pass.h"
#include "surf/sem/filter_bank.h"
#include "surf/sem/image_model.h"

namespace surf {

/// The passes of a filter bank in float or double. Parameters and fields must have been checked.
template <class T>
class BankEngine {
 public:
  BankEngine(const FilterBankParameters& parameters, double pitch_x_nm, double pitch_y_nm,
             const ModelOptions& options);

  ModelImages predict(const Grid<double>& z_nm) const;
  Grid<double> gradient(const Grid<double>& z_nm, const ModelImages& weights) const;
  ModelImages change(const Grid<double>& z_nm, const Grid<double>& dz_nm) const;

  std::vector<facet::Block> blocks(const Grid<double>& z_nm) const {
    return pass_.blocks(z_nm.width(), z_nm.height());
  }

  /// Receives all invariants of block i: for every scale its slope, largest and smallest principal
  /// curvature, row by row, `columns` numbers each. Called from several threads.
  using Sink = std::function<void(std::size_t i, const facet::Block& block, int columns,
                                  const std::vector<AlignedVector<T>>& scales)>;
  void invariants(const Grid<double>& z_nm, const Sink& sink) const;

 private:
  /// A worker's memory for fits of a block at all scales, some of them on coarser heights.
  struct Scratch {
    typename facet::FacetPass<T>::Scratch fine;
    AlignedVector<T> coarse, between, weights;
  };
  facet::CoarseFits<T> coarse_fits(const Grid<double>& z_nm) const;
  const T* fit(int scale, const facet::CoarseFits<T>& coarse, const facet::Block& block,
               Scratch& scratch) const;
  facet::Floors<T> floors(int scale, const facet::CoarseFits<T>& coarse,
                          const Scratch& scratch) const;
  int scales() const { return static_cast<int>(fine_of_.size()); }
  ModelImages blank(const Grid<double>& z_nm, bool with_offset) const;
  void add(const facet::Block& block, const AlignedVector<T>& sum, double unit,
           ModelImages& images) const;
  void take_weights(const ModelImages& weights, double unit, const facet::Block& block,
                    AlignedVector<T>& out) const;
  void pull_back(const Grid<double>& z_nm, const AlignedVector<T>& weights, int scale,
                 const facet::CoarseFits<T>& coarse, const facet::Block& block, Scratch& scratch,
                 T* out) const;

  const FilterBankParameters& parameters_;
  ModelOptions options_;
  double pitch_x_nm_, pitch_y_nm_;
  std::vector<int> fine_of_;   ///< [scale]: its index in pass_, or -1 if its heights are subsampled
  std::vector<int> scale_of_;  ///< inverse of fine_of_
  facet::FacetPass<T> pass_;
  std::vector<std::vector<facet::Weights<T>>> weights_;  ///< [scale][channel]
};

extern template class BankEngine<float>;
extern template class BankEngine<double>;

/// Calls `work(engine)` with an engine in the precision that the options ask for.
template <class Work>
auto run_bank(const FilterBankParameters& parameters, double pitch_x_nm, double pitch_y_nm,
              const ModelOptions& options, const Work& work) {
  if (options.double_precision)
    return work(BankEngine<double>(parameters, pitch_x_nm, pitch_y_nm, options));
  return work(BankEngine<float>(parameters, pitch_x_nm, pitch_y_nm, options));
}

}  // namespace surf
