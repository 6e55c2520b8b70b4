// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/sampling/expected_primaries.h"

#include <algorithm>

#include "results/seen_pixels.h"
#include "sampling/adaptive_sampling.h"

namespace surf::mc {

double expected_primaries(const SimulationResult& r, double accuracy) {
  double all = 0;
  for_seen_pixels(r, [&](int x, int y) {
    const PixelTally& p = r.pixels(x, y);
    if (p.model == PixelModel::plane) return;
    const auto n = static_cast<double>(p.primaries);
    double wanted = fewest_primaries;
    for (std::size_t d = 0; d < r.detectors.size(); ++d) {
      const double efficiency = r.detectors[d].efficiency;
      const double own = estimate(p.primaries, r.counts[d](x, y)).standard_error * efficiency;
      const double t = target(r, d, std::max(0.0, r.yield(d, x, y).mean), accuracy);
      if (t > 0) wanted = std::max(wanted, own * own * n / (t * t));
    }
    all += pilot_primaries + reserve_of_primaries * wanted;
  });
  return all;
}

}  // namespace surf::mc
