// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "surf/io/plot.h"

namespace surf::test {

/// Two lines with error bars over a logarithmic axis, a band and a reference line.
inline io::PlotPanel yields_panel() {
  io::PlotPanel panel;
  panel.title = "Yields";
  panel.x = {"energy (eV)", true, {}};
  panel.y.label = "yield (electrons per primary)";
  io::PlotSeries se, bse;
  for (double e = 100; e < 1e4; e *= 1.35) {
    se.x.push_back(e);
    se.y.push_back(2.5 * std::exp(-0.5 * std::pow(std::log(e / 350), 2)));
    se.y_error.push_back(0.09);
    bse.y.push_back(0.2 + 0.03 * std::sin(std::log(e)));
    bse.y_error.push_back(0.03);
  }
  bse.x = se.x;
  se.name = "SE";
  bse.name = "BSE";
  bse.dashed = true;
  se.style = bse.style = io::PlotStyle::line_points;
  panel.series = {se, bse};
  panel.references = {{io::PlotDirection::horizontal, 1, "one for one"}};
  panel.bands = {{io::PlotDirection::vertical, 300, 500, "maximum"}};
  return panel;
}

/// Thirty points in four series on logarithmic axes, the best of them joined and named.
inline io::PlotPanel pareto_panel() {
  io::PlotPanel panel;
  panel.x = {"time per image (s)", true, {}};
  panel.y = {"relative standard error", true, {}};
  const char* const names[] = {"direct", "splitting", "stored cascades", "fast model"};
  for (int s = 0; s < 4; ++s) {
    io::PlotSeries series;
    series.name = names[s];
    series.style = io::PlotStyle::points;
    for (int i = 0; i < (s < 2 ? 8 : 7); ++i) {
      const double time = std::pow(10, -1 + 0.5 * i - 0.3 * s);
      series.x.push_back(time);
      series.y.push_back(0.3 / std::sqrt(time) / (1 + s) * (1 + 0.9 * std::sin(3.0 * i + s)));
    }
    panel.series.push_back(series);
  }
  io::PlotSeries front;
  front.name = "Pareto front";
  front.x = panel.series[3].x;
  front.y = panel.series[3].y;
  front.dashed = true;
  front.color = 6;
  for (std::size_t i = 0; i < front.x.size(); ++i) {
    panel.notes.push_back({"variant " + std::to_string(i), front.x[i], front.y[i]});
  }
  panel.series.push_back(front);
  return panel;
}

/// A histogram with a fitted curve.
inline io::PlotPanel noise_panel(io::PlotStyle style) {
  io::PlotPanel panel;
  panel.title = "Noise of a scan line";
  panel.x.label = "height difference (nm)";
  panel.y.label = "samples";
  const auto density = [](double x) { return 400 * std::exp(-0.5 * x * x); };
  io::PlotSeries counts, fit;
  counts.name = "measured";
  counts.style = style;
  for (int i = 0; i < 32; ++i) {
    const double x = -4 + 0.25 * i;
    counts.x.push_back(x);
    counts.y.push_back(std::floor(density(x + 0.125) * (1 + 0.05 * std::sin(7.0 * i))));
    counts.y_error.push_back(std::sqrt(counts.y.back()));
  }
  counts.x.push_back(4);
  fit.name = "normal, \xCF\x83 = 1.00 nm";
  for (double x = -4; x <= 4; x += 0.05) {
    fit.x.push_back(x);
    fit.y.push_back(density(x));
  }
  panel.series = {counts, fit};
  return panel;
}

}  // namespace surf::test
