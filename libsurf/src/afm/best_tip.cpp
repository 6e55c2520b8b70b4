// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/best_tip.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "surf/afm/blind_tip.h"
#include "surf/afm/height_range.h"
#include "surf/afm/tip_measure.h"
#include "surf/core/error.h"
#include "surf/core/parallel.h"
#include "tip_fit.h"

namespace surf {

namespace {

// The outer bounds to start from. Thresholds are in standard deviations of the noise. The interval
// with the largest jump of volume is refined `refinements` times, by `between` thresholds each.
// Apex tolerances are in thresholds. Larger tolerances give more accurate fits, or none.
constexpr int thresholds = 10;
constexpr double least_sigmas = 2.5, step_sigmas = 0.5;
constexpr int refinements = 2, between = 3;
constexpr double tolerances[] = {0.8, 1.25};
// After a sixteenth of the iterations a larger misfit shows that the bound is too blunt.
constexpr double hopeless_misfit = 4;

void check(const BestTipOptions& o) {
  if (!(std::fabs(o.noise.alpha) < 1 && o.noise.innovation_nm2 > 0 &&
        std::isfinite(o.noise.innovation_nm2)))
    throw InvalidInput("noise",
                       fmt::format("alpha {:g} with an innovation of {:g} nm^2 is no model",
                                   o.noise.alpha, o.noise.innovation_nm2),
                       "Give alpha between -1 and 1 and a variance above 0");
  if (o.iterations < 1) throw UsageError("iterations", "there are none", "Ask for 100");
}

struct Start {
  double threshold_nm = 0, tolerance = 0, volume_nm3 = 0;
  Tip tip;
};

// The index of the broader of the two neighbours whose volumes differ most.
std::size_t largest_jump(const std::vector<Start>& starts) {
  std::size_t upper = 0;
  double most = -1;
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const double drop = starts[k].volume_nm3 - starts[k + 1].volume_nm3;
    if (drop > most) {
      most = drop;
      upper = k;
    }
  }
  return upper;
}

class OuterBounds {
 public:
  OuterBounds(const std::vector<HeightField>& scans, const BestTipOptions& options)
      : scans_(scans) {
    options_.width = options.width;
    options_.height = options.height;
    options_.watch = {{}, options.watch.cancel};
    options_.threads = 1;  // frames are small: families of bounds are computed in parallel instead
    range_nm_ = std::max(height_range(scans).span_nm(), 1e-9);
  }

  Start at(double threshold_nm, double tolerance, const Start* broader) const {
    BlindTipOptions o = options_;
    o.threshold_nm = threshold_nm;
    o.apex_tolerance_nm = tolerance * threshold_nm;
    if (broader) o.start = broader->tip;
    Start start{threshold_nm, tolerance, 0, blind_tip(scans_, o).tip};
    start.volume_nm3 = tip_volume_nm3(start.tip, range_nm_);
    return start;
  }

  // Bounds by falling threshold; each starts from the bound before it.
  std::vector<Start> family(double sigma_nm, double tolerance) const {
    std::vector<Start> starts;
    for (int n = thresholds - 1; n >= 0; --n)
      starts.push_back(at((least_sigmas + n * step_sigmas) * sigma_nm, tolerance,
                          starts.empty() ? nullptr : &starts.back()));
    for (int n = 0; n < refinements; ++n) {
      const std::size_t upper = largest_jump(starts);
      const double from = starts[upper].threshold_nm, to = starts[upper + 1].threshold_nm;
      for (int k = 1; k <= between; ++k) {
        const std::size_t place = upper + static_cast<std::size_t>(k);
        Start start = at(from + (to - from) * k / (between + 1), tolerance, &starts[place - 1]);
        starts.insert(starts.begin() + static_cast<std::ptrdiff_t>(place), std::move(start));
      }
    }
    return starts;
  }

 private:
  const std::vector<HeightField>& scans_;
  BlindTipOptions options_;
  double range_nm_ = 0;
};

}  // namespace

BestTip best_tip(const std::vector<HeightField>& scans, const BestTipOptions& options) {
  check(options);
  BestTip out;
  BestTipSummary& summary = out.summary;
  const double sigma = std::sqrt(options.noise.variance_nm2());
  const OuterBounds bounds(scans, options);
  constexpr double families = std::size(tolerances), total = families + 2;
  const Watch& watch = options.watch;
  std::vector<Start> starts;
  const int threads = resolve_threads(options.threads);
  std::vector<std::vector<Start>> by_tolerance(std::size(tolerances));
  parallel_for(by_tolerance.size(), threads,
               [&](std::size_t k, int) { by_tolerance[k] = bounds.family(sigma, tolerances[k]); });
  for (const auto& family : by_tolerance) starts.insert(starts.end(), family.begin(), family.end());
  watch.report(families, total);
  for (const Start& s : starts)
    summary.candidates.push_back({s.threshold_nm, s.tolerance, 0, 0, 0});
  std::vector<TipFit> fits(starts.size());
  parallel_for(fits.size(), threads, [&](std::size_t k, int) {
    watch.check();
    fits[k] = TipFit(scans, options.noise, starts[k].tip);
    fits[k].iterate(std::max(1, options.iterations / 16));
    const bool hopeless = fits[k].misfit() > hopeless_misfit;
    if (!hopeless) fits[k].iterate(std::max(1, options.iterations / 16));
    TipCandidate& c = summary.candidates[k];
    c = {c.threshold_nm, c.tolerance, fits[k].misfit(), fits[k].freedom(),
         hopeless ? fits[k].risk() : fits[k].risk_when_thinned()};
  });
  watch.report(total - 1, total);
  // Only the best few are fitted to the end.
  constexpr std::size_t finalists = 3;
  std::vector<std::size_t> order(fits.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return summary.candidates[a].risk < summary.candidates[b].risk;
  });
  order.resize(std::min(order.size(), finalists));
  parallel_for(order.size(), threads, [&](std::size_t k, int) {
    watch.check();
    fits[order[k]].iterate(options.iterations);
  });
  watch.report(total, total);
  const std::size_t best = *std::min_element(
      order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return fits[a].risk() < fits[b].risk(); });
  const TipFit& fit = fits[best];
  summary.chosen = {starts[best].threshold_nm, starts[best].tolerance, fit.misfit(), fit.freedom(),
                    fit.risk()};
  summary.standard_error_nm = fit.standard_errors();
  for (const double e : summary.standard_error_nm.data()) summary.touched += std::isfinite(e);
  out.tip = fit.tip();
  return out;
}

}  // namespace surf
