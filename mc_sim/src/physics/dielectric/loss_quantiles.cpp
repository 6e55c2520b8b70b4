// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/loss_quantiles.h"

namespace surf::mc {

std::vector<double> quantiles_of(std::span<const double> edges, std::span<const double> sums) {
  std::vector<double> out(Quantiles::points);
  const std::size_t last = edges.size() - 1;
  std::size_t first = 0, end = last;  // where there is anything
  while (first + 1 < last && !(sums[first + 1] > 0)) ++first;
  while (end > first + 1 && !(sums[end - 1] < sums[last])) --end;
  out.front() = edges[first];
  out.back() = edges[end];
  std::size_t k = first;
  for (int i = 1; i < Quantiles::cells; ++i) {
    const double wanted = Quantiles::probability(i) * sums[last];
    while (k + 1 < end && sums[k + 1] <= wanted) ++k;
    const double width = sums[k + 1] - sums[k];
    out[static_cast<std::size_t>(i)] =
        edges[k] + (width > 0 ? (wanted - sums[k]) / width : 0) * (edges[k + 1] - edges[k]);
  }
  return out;
}

}  // namespace surf::mc
