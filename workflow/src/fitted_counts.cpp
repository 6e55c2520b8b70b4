// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/fitted_counts.h"

#include <fmt/format.h>

#include <algorithm>

#include "surf/core/units.h"

namespace surf::workflow {
namespace {

constexpr std::size_t most_bars = 60;

/// Counts where anything is to be seen.
std::pair<std::size_t, std::size_t> shown(const FittedCounts& f) {
  const auto& n = f.set.counts;
  const auto first = static_cast<std::size_t>(
      std::ranges::find_if(n, [](std::int64_t v) { return v > 0; }) - n.begin());
  return {first, n.size()};
}

io::PlotPanel panel(const FittedCounts& f) {
  const auto [first, end] = shown(f);
  const std::size_t step = (end - first + most_bars - 1) / most_bars;  // counts to a bar
  const double trials = static_cast<double>(f.moments.trials);
  io::PlotSeries seen{.name = "simulated", .style = io::PlotStyle::bars, .color = 2};
  io::PlotSeries poisson{.name = "Poisson", .style = io::PlotStyle::line_points, .color = 1};
  io::PlotSeries log_normal{.name = "log-normal", .style = io::PlotStyle::line_points, .color = 0};
  io::PlotSeries normal{.name = "normal", .dashed = true, .color = 3};
  for (std::size_t from = first; from < end; from += step) {
    double share = 0, p = 0, l = 0, n = 0;
    for (std::size_t k = from; k < from + step; ++k) {
      const auto count = static_cast<std::int64_t>(k);
      if (k < end) share += static_cast<double>(f.set.counts[k]) / trials;
      p += f.poisson.probability(count);
      if (f.spread) l += f.log_normal.probability(count), n += f.normal.probability(count);
    }
    const double width = static_cast<double>(step), left = static_cast<double>(from) - 0.5;
    seen.x.push_back(left), seen.y.push_back(share / width);
    for (io::PlotSeries* s : {&poisson, &log_normal, &normal}) s->x.push_back(left + 0.5 * width);
    poisson.y.push_back(p / width), log_normal.y.push_back(l / width),
        normal.y.push_back(n / width);
  }
  seen.x.push_back(seen.x.back() + static_cast<double>(step));
  io::PlotPanel panel;
  panel.title = fmt::format("{} of {} primar{}", f.set.detector, f.set.electrons,
                            f.set.electrons == 1 ? "y" : "ies");
  panel.x.label = "electrons counted";
  panel.y.label = "share of trials";
  panel.series = {seen, poisson};
  if (f.spread) panel.series.insert(panel.series.end(), {log_normal, normal});
  return panel;
}

}  // namespace

FittedCounts fit_counts(const DetectorCounts& set) {
  FittedCounts f;
  f.set = set;
  f.moments = moments(set.counts);
  f.poisson = fit_poisson(set.counts);
  f.spread = f.moments.variance > 0;
  if (f.spread) f.log_normal = fit_log_normal(set.counts), f.normal = fit_normal(set.counts);
  return f;
}

io::Plot plot_counts(const std::vector<FittedCounts>& sets, int detectors) {
  io::Plot plot;
  for (const FittedCounts& f : sets) plot.panels.push_back(panel(f));
  plot.columns = detectors;
  return plot;
}

std::string counts_csv(const std::vector<FittedCounts>& sets,
                       const std::map<std::string, std::string>& made) {
  std::string text;
  for (const auto& [key, value] : made) text += fmt::format("# {} = {}\n", key, value);
  text += "detector,primaries,count,trials,poisson,log_normal,normal\n";
  for (const FittedCounts& f : sets)
    for (std::size_t k = 0; k < f.set.counts.size(); ++k) {
      const auto count = static_cast<std::int64_t>(k);
      const double trials = static_cast<double>(f.moments.trials);
      text += fmt::format("{},{},{},{},{}", f.set.detector, f.set.electrons, k, f.set.counts[k],
                          format_exact(trials * f.poisson.probability(count)));
      text += f.spread
                  ? fmt::format(",{},{}\n", format_exact(trials * f.log_normal.probability(count)),
                                format_exact(trials * f.normal.probability(count)))
                  : ",,\n";
    }
  return text;
}

}  // namespace surf::workflow
