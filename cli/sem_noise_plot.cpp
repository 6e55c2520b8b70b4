// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_noise_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surf::cli {
namespace {

constexpr int line_samples = 100;
constexpr std::size_t most_points = 60, groups = 30;

struct Bar {
  double mean = 0, variance = 0, error = 0;
};

/// Too many points hide each other and the line: weighted means of those of neighbouring means
/// then.
std::vector<Bar> bars_of(const SemNoiseEstimate& e) {
  std::vector<NoisePoint> used;
  for (const NoisePoint& p : e.points)
    if (p.used && p.variance_stderr > 0) used.push_back(p);
  std::ranges::stable_sort(used, {}, &NoisePoint::mean);
  const std::size_t n = used.size(), bars = n > most_points ? groups : n;
  std::vector<Bar> out(bars);
  for (std::size_t b = 0; b < bars; ++b) {
    double weights = 0;
    for (std::size_t i = b * n / bars; i < (b + 1) * n / bars; ++i) {
      const double w = 1 / (used[i].variance_stderr * used[i].variance_stderr);
      weights += w, out[b].mean += w * used[i].mean, out[b].variance += w * used[i].variance;
    }
    out[b].mean /= weights, out[b].variance /= weights, out[b].error = 1 / std::sqrt(weights);
  }
  return out;
}

io::PlotPanel variances(const SemNoiseEstimate& e) {
  const std::vector<Bar> bars = bars_of(e);
  const auto count = std::ranges::count_if(e.points, [](const NoisePoint& p) { return p.used; });
  io::PlotSeries used{.name = count > static_cast<std::int64_t>(bars.size())
                                  ? fmt::format("{} flat places, averaged", count)
                                  : "flat places",
                      .style = io::PlotStyle::points,
                      .color = 0};
  for (const Bar& b : bars)
    used.x.push_back(b.mean), used.y.push_back(b.variance), used.y_error.push_back(b.error);
  const double least = e.least_mean, largest = e.largest_mean;
  io::PlotSeries line{
      .name = fmt::format("{:.4g} mean {} {:.4g}", e.noise.slope, e.noise.intercept < 0 ? "-" : "+",
                          std::fabs(e.noise.intercept)),
      .color = 1};
  io::PlotSeries above{.name = "two standard errors of it", .dashed = true, .color = 1},
      below = above;
  below.name.clear();
  const double margin = 0.05 * std::max(largest - least, 1e-9 * std::max(std::fabs(largest), 1e-9));
  for (int i = 0; i <= line_samples; ++i) {
    const double mean = least - margin + (largest - least + 2 * margin) * i / line_samples;
    for (io::PlotSeries* s : {&line, &above, &below}) s->x.push_back(mean);
    const double v = e.noise.variance(mean), error = 2 * e.variance_stderr(mean);
    line.y.push_back(v), above.y.push_back(v + error), below.y.push_back(std::max(v - error, 0.0));
  }
  io::PlotPanel panel;
  panel.title = fmt::format("Variance against mean\nchi-squared {:.4g} with {} degrees of freedom",
                            e.chi_squared, e.degrees);
  panel.x.label = "mean (grey levels)";
  panel.y.label = "variance (grey levels²)";
  if (!used.x.empty()) panel.series.push_back(used);
  panel.series.insert(panel.series.end(), {line, above, below});
  return panel;
}

io::PlotPanel places(const SemNoiseEstimate& e, int width_px, int height_px) {
  io::PlotSeries used{.name = "used", .style = io::PlotStyle::points, .color = 0};
  io::PlotSeries left_out{.name = "left out", .style = io::PlotStyle::points, .color = 5};
  for (const NoisePoint& p : e.points) {
    io::PlotSeries& to = p.used ? used : left_out;
    to.x.push_back(0.5 * (p.region.x0 + p.region.x1));
    to.y.push_back(0.5 * (p.region.y0 + p.region.y1));
  }
  io::PlotPanel panel;
  panel.title = "Where they are";
  panel.x.label = "column";
  panel.y.label = "row, from below";
  panel.x.range = {0, static_cast<double>(width_px)};
  panel.y.range = {0, static_cast<double>(height_px)};
  for (const io::PlotSeries& s : {used, left_out})
    if (!s.x.empty()) panel.series.push_back(s);
  return panel;
}

}  // namespace

io::Plot plot_sem_noise(const SemNoiseEstimate& e, int width_px, int height_px) {
  io::Plot plot;
  plot.panels = {variances(e), places(e, width_px, height_px)};
  plot.columns = 2;
  return plot;
}

}  // namespace surf::cli
