// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace surf::workflow {

struct Trade {
  double time = 0, error = 0;
};

/// The Pareto front: the trades that no other trade beats in one respect without being worse in the
/// other, as indices into `trades`, in order of time. Of equal trades the first counts. Trades that
/// are not finite are left out.
std::vector<std::size_t> pareto_front(const std::vector<Trade>& trades);

}  // namespace surf::workflow
