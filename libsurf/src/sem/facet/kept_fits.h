// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "core/aligned.h"
#include "sem/facet/facet_operations.h"
#include "sem/facet/facet_pass.h"

namespace surf::facet {

/// The fits that images were made of, kept for their derivatives: reading them takes less time than
/// making them again. Images whose fits would take more than `most_bytes` keep none.
template <class T>
struct KeptFits {
  static constexpr std::size_t most_bytes = std::size_t{256} << 20;

  struct Fit {
    AlignedVector<T> coefficients;  ///< of a block at a scale, as FacetPass::fit gives them
    Floors<T> floors;
  };
  std::vector<Fit> fits;  ///< [block][scale]; empty where none are kept
  int scales = 0;

  bool empty() const { return fits.empty(); }
  const Fit& at(std::size_t block, int scale) const {
    return fits[block * static_cast<std::size_t>(scales) + static_cast<std::size_t>(scale)];
  }

  /// Makes room where that is allowed. `more_bytes`: what is kept beside the fits.
  void prepare(const std::vector<Block>& blocks, int scale_count, int columns,
               std::size_t more_bytes = 0) {
    std::size_t rows = 0;
    for (const Block& block : blocks) rows += static_cast<std::size_t>(block.rows);
    const std::size_t bytes =
        rows * static_cast<std::size_t>(scale_count * coefficients * columns) * sizeof(T);
    if (bytes + more_bytes > most_bytes) return;
    scales = scale_count;
    fits.resize(blocks.size() * static_cast<std::size_t>(scale_count));
  }
  /// Different blocks may be kept from different threads.
  void keep(std::size_t block, int scale, int rows, int columns, const T* k,
            const Floors<T>& floors) {
    Fit& fit = fits[block * static_cast<std::size_t>(scales) + static_cast<std::size_t>(scale)];
    fit.coefficients.assign(k, k + std::ptrdiff_t{rows} * coefficients * columns);
    fit.floors = floors;
  }
};

}  // namespace surf::facet
