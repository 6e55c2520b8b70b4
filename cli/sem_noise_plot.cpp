// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem_noise_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surf::cli {
namespace {

constexpr int line_samples = 100;

io::PlotPanel variances(const SemNoiseEstimate& e) {
  io::PlotSeries used{.name = "flat places", .style = io::PlotStyle::points, .color = 0};
  io::PlotSeries left_out{.name = "left out", .style = io::PlotStyle::points, .color = 5};
  double least = e.least_mean, largest = e.largest_mean;
  for (const NoisePoint& p : e.points) {
    io::PlotSeries& to = p.used ? used : left_out;
    to.x.push_back(p.mean);
    to.y.push_back(p.variance);
    to.y_error.push_back(p.variance_stderr);
    least = std::min(least, p.mean), largest = std::max(largest, p.mean);
  }
  io::PlotSeries line{.name = fmt::format("{:.4g} mean {} {:.4g}", e.noise.slope, e.noise.intercept < 0 ? "-" : "+",
                                          std::fabs(e.noise.intercept)),
                      .color = 1};
  io::PlotSeries above{.name = "two standard errors of it", .dashed = true, .color = 1}, below = above;
  below.name.clear();
  const double margin = 0.05 * std::max(largest - least, 1e-9 * std::max(std::fabs(largest), 1e-9));
  for (int i = 0; i <= line_samples; ++i) {
    const double mean = least - margin + (largest - least + 2 * margin) * i / line_samples;
    for (io::PlotSeries* s : {&line, &above, &below}) s->x.push_back(mean);
    const double v = e.noise.variance(mean), error = 2 * e.variance_stderr(mean);
    line.y.push_back(v), above.y.push_back(v + error), below.y.push_back(std::max(v - error, 0.0));
  }
  io::PlotPanel panel;
  panel.title = fmt::format("Variance against mean\nchi-squared {:.4g} with {} degrees of freedom", e.chi_squared, e.degrees);
  panel.x.label = "mean (grey levels)";
  panel.y.label = "variance (grey levels²)";
  if (!used.x.empty()) panel.series.push_back(used);
  if (!left_out.x.empty()) panel.series.push_back(left_out);
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
