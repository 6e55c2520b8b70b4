// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surf::cli {
namespace {

constexpr int most_lags = 30;
constexpr double farthest = 5;  // standard deviations

io::PlotPanel autocovariances(const Grid<double>& residual_nm, const Grid<double>& white,
                              const Mask& samples, const AfmNoise& noise) {
  const int lags = std::min(most_lags, residual_nm.width() - 1);
  io::PlotSeries before{.name = "residual", .style = io::PlotStyle::points};
  io::PlotSeries model{.name = fmt::format("model, alpha {:.3f}", noise.alpha), .dashed = true};
  io::PlotSeries after{.name = "whitened", .style = io::PlotStyle::line_points};
  before.y = autocovariance(residual_nm, lags, samples);
  after.y = autocovariance(white, lags, samples);
  for (int lag = 0; lag <= lags; ++lag) {
    before.x.push_back(lag);
    model.y.push_back(noise.variance_nm2() * std::pow(noise.alpha, lag));
    after.y[static_cast<std::size_t>(lag)] *= noise.innovation_nm2;
  }
  model.x = after.x = before.x;
  io::PlotPanel panel;
  panel.title = "Autocovariance along rows";
  panel.x.label = "distance (columns)";
  panel.y.label = "autocovariance (nm²)";
  panel.series = {before, model, after};
  panel.references = {{.at = 0}};
  return panel;
}

io::PlotPanel density(const Grid<double>& white, const Mask& samples, const NoiseCheck& check) {
  const int bins =
      std::clamp(static_cast<int>(std::sqrt(static_cast<double>(check.samples)) / 3), 10, 100);
  io::PlotSeries found{.name = "whitened", .style = io::PlotStyle::bars}, normal{.name = "normal"};
  found.y.assign(static_cast<std::size_t>(bins), 0);
  const double width = 2 * farthest / bins;
  for (std::size_t i = 0; i < white.size(); ++i)
    if (const double bin = (white.data()[i] + farthest) / width;
        samples.data()[i] && bin >= 0 && bin < bins)
      found.y[static_cast<std::size_t>(bin)] += 1 / (width * static_cast<double>(check.samples));
  for (int i = 0; i <= bins; ++i) found.x.push_back(-farthest + i * width);
  for (int i = 0; i <= 200; ++i) {
    normal.x.push_back(-farthest + i * farthest / 100);
    normal.y.push_back(std::exp(-0.5 * normal.x.back() * normal.x.back()) /
                       std::sqrt(2 * std::numbers::pi));
  }
  io::PlotPanel panel;
  panel.title =
      fmt::format("Density of the whitened residual\nskewness {:.2f}, excess kurtosis {:.2f}",
                  check.skewness, check.excess_kurtosis);
  panel.x.label = "whitened residual (standard deviations)";
  panel.y.label = "density";
  panel.series = {found, normal};
  return panel;
}

}  // namespace

io::Plot plot_noise(const Grid<double>& residual_nm, const Grid<double>& white, const Mask& samples,
                    const AfmNoise& noise, const NoiseCheck& check) {
  io::Plot plot;
  plot.panels = {autocovariances(residual_nm, white, samples, noise),
                 density(white, samples, check)};
  plot.columns = 2;
  return plot;
}

}  // namespace surf::cli
