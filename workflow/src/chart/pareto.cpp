// SPDX-License-Identifier: GPL-3.0-or-later
#include "pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace surf::workflow {

std::vector<std::size_t> pareto_front(const std::vector<Trade>& trades) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trades.size(); ++i)
    if (std::isfinite(trades[i].time) && std::isfinite(trades[i].error)) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(trades[a].time, trades[a].error, a) <
           std::tuple(trades[b].time, trades[b].error, b);
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order)
    if (trades[i].error < least) {
      least = trades[i].error;
      front.push_back(i);
    }
  return front;
}

}  // namespace surf::workflow
