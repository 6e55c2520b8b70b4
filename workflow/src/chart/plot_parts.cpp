// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot_parts.h"

namespace surf::workflow {

io::PlotSeries front_series(const std::vector<Trade>& trades) {
  io::PlotSeries front;
  front.name = "Pareto front";
  front.color = 6;
  front.style = io::PlotStyle::line;
  for (const std::size_t i : pareto_front(trades)) {
    if (!front.x.empty()) {
      front.x.push_back(trades[i].time);
      front.y.push_back(front.y.back());
    }
    front.x.push_back(trades[i].time);
    front.y.push_back(trades[i].error);
  }
  return front;
}

}  // namespace surf::workflow
