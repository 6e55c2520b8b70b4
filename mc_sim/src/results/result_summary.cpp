// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/results/result_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "results/seen_pixels.h"

namespace surf::mc {

namespace {

// Where a library's cascades are shared, its share of a pixel's error is the same way off in all.
double common_error(const SimulationResult& r, std::size_t d, int x, int y, const Estimate& e) {
  if (r.library_cascades == 0) return 0;
  const double efficiency = r.detectors[d].efficiency;
  const double of_control =
      r.controls.empty() ? 0 : r.controls[d](x, y).standard_error * efficiency;
  const double drawn =
      static_cast<double>(r.pixels(x, y).primaries) / static_cast<double>(r.library_cascades);
  return std::min(e.standard_error,
                  std::hypot(of_control, e.standard_error * std::sqrt(std::min(1.0, drawn))));
}

}  // namespace

const char* name(PixelModel model) {
  switch (model) {
    case PixelModel::none:
      return "none";
    case PixelModel::direct:
      return "direct";
    case PixelModel::replay:
      return "replay";
    case PixelModel::difference:
      return "difference";
    case PixelModel::plane:
      return "plane";
  }
  return "unknown";
}

ResultSummary summarize(const SimulationResult& r) {
  ResultSummary s;
  const std::size_t detectors = r.detectors.size();
  s.pixels = static_cast<std::int64_t>(r.pixels.width()) * r.pixels.height();
  s.fewest_electrons = std::numeric_limits<std::int64_t>::max();
  std::vector<double> sum(detectors), variance(detectors), common(detectors);
  std::int64_t unseen_by_model = s.pixels;
  for_seen_pixels(r, [&](int x, int y) {
    const PixelTally& p = r.pixels(x, y);
    ++s.seen;
    --unseen_by_model;
    ++s.models[static_cast<std::size_t>(p.model)];
    s.electrons[static_cast<std::size_t>(p.model)] += p.primaries;
    s.mean_electrons += static_cast<double>(p.primaries);
    s.fewest_electrons = std::min(s.fewest_electrons, p.primaries);
    s.most_electrons = std::max(s.most_electrons, p.primaries);
    double worst = 0;
    for (std::size_t d = 0; d < detectors; ++d) {
      const Estimate e = r.yield(d, x, y);
      const double shared = common_error(r, d, x, y, e);
      sum[d] += e.mean;
      common[d] += shared;
      variance[d] += e.standard_error * e.standard_error - shared * shared;
      if (const double accuracy = accuracy_of(r.budget); accuracy > 0) {
        const double t = target(r, d, e.mean, accuracy);
        if (t > 0) worst = std::max(worst, e.standard_error / t);
      }
    }
    s.worst = std::max(s.worst, worst);
    if (worst > ResultSummary::missed_by) ++s.missed;
  });
  s.models[static_cast<std::size_t>(PixelModel::none)] += unseen_by_model;
  const double n = static_cast<double>(std::max<std::int64_t>(1, s.seen));
  if (s.seen == 0) s.fewest_electrons = 0;
  s.mean_electrons /= n;
  for (std::size_t d = 0; d < detectors; ++d)
    s.yields.push_back(
        {sum[d] / n, std::hypot(std::sqrt(std::max(0.0, variance[d])), common[d]) / n});
  return s;
}

std::size_t planes_used(const SimulationResult& r) {
  std::set<std::pair<double, double>> means;
  if (r.controls.empty()) return 0;
  for_seen_pixels(r, [&](int x, int y) {
    const PixelModel model = r.pixels(x, y).model;
    if (model != PixelModel::difference && model != PixelModel::plane) return;
    const Control& c = r.controls.front()(x, y);
    means.insert({c.mean, c.standard_error});
  });
  return means.size();
}

}  // namespace surf::mc
