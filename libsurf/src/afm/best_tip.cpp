// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/best_tip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "surf/afm/blind_tip.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "tip_fit.h"

namespace surf {

namespace {

constexpr int thresholds = 25;                            // of the outer bounds to begin with,
constexpr double least_sigmas = 2, step_sigmas = 0.25;    // in standard deviations of the noise

void check(const BestTipOptions& o) {
  if (!(std::fabs(o.noise.alpha) < 1 && o.noise.innovation_nm2 > 0 && std::isfinite(o.noise.innovation_nm2)))
    throw InvalidInput("noise", fmt::format("alpha {:g} with an innovation of {:g} nm^2 is no model",
                                            o.noise.alpha, o.noise.innovation_nm2),
                       "Give alpha between -1 and 1 and a variance above 0");
  if (o.iterations < 1) throw UsageError("iterations", "there are none", "Ask for 100");
}

}  // namespace

Tip best_tip(const std::vector<HeightField>& scans, const BestTipOptions& options,
             BestTipSummary& summary, const ProgressCallback& progress, const CancelToken* cancel) {
  check(options);
  summary = {};
  const double sigma = std::sqrt(options.noise.variance_nm2());
  constexpr double total = 3 * thresholds;
  const auto report = [&](double done) {
    if (progress) progress(done, total);
  };
  const auto stopped = [&] { return cancel && cancel->cancelled(); };
  BlindTipOptions bound;
  bound.width = options.width;
  bound.height = options.height;
  bound.threads = options.threads;
  std::vector<Tip> starts;
  for (int n = thresholds - 1; n >= 0; --n) {   // each begins with that of the threshold above
    bound.threshold_nm = bound.apex_tolerance_nm = (least_sigmas + n * step_sigmas) * sigma;
    BlindTipSummary ignored;
    starts.push_back(blind_tip(scans, bound, ignored, {}, cancel));
    bound.start = starts.back();
    summary.candidates.push_back({bound.threshold_nm, 0, 0, 0});
    report(thresholds - n);
    if (stopped()) return starts.back();
  }
  const int threads = resolve_threads(options.threads);
  std::vector<TipFit> fits;
  for (const Tip& start : starts) fits.emplace_back(scans, options.noise, start);
  parallel_for(fits.size(), threads, [&](std::size_t k, int) {
    if (stopped()) return;
    fits[k].iterate(std::max(1, options.iterations / 8));
    TipCandidate& c = summary.candidates[k];
    c = {c.threshold_nm, fits[k].misfit(), fits[k].freedom(), fits[k].risk()};
  });
  report(2 * thresholds);
  if (stopped()) return starts.back();
  // The few best are fitted to the end.
  constexpr std::size_t finalists = 3;
  std::vector<std::size_t> order(fits.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return fits[a].risk() < fits[b].risk(); });
  order.resize(std::min(order.size(), finalists));
  parallel_for(order.size(), threads, [&](std::size_t k, int) {
    if (!stopped()) fits[order[k]].iterate(options.iterations);
  });
  report(total);
  const std::size_t best = *std::min_element(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fits[a].risk() < fits[b].risk();
  });
  const TipFit& fit = fits[best];
  summary.chosen = {summary.candidates[best].threshold_nm, fit.misfit(), fit.freedom(), fit.risk()};
  summary.standard_error_nm = fit.standard_errors();
  for (const double e : summary.standard_error_nm.data()) summary.touched += std::isfinite(e);
  return fit.tip();
}

}  // namespace surf
