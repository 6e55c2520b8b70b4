// SPDX-License-Identifier: GPL-3.0-or-later
#include "chart_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "plot_parts.h"
#include "surf/core/units.h"

namespace surf::workflow {
namespace {

// A logarithmic axis cannot show 0, the error of an exact method.
constexpr double least_error = 1e-6, least_s = 1e-5;

struct Place {
  const ChartPoint* point;
  double time, error;  // s, %
};

std::vector<Place> places(const ChartSummary& summary, std::size_t channel, bool prepared) {
  std::vector<Place> out;
  for (const ChartPoint& p : summary.points)
    out.push_back({&p, std::max(least_s, prepared ? p.run_s : p.total_s()),
                   100 * std::max(least_error, p.channels[channel].error.rms)});
  return out;
}

// Each family has its own look; models older than the filter bank share one. A dashed line means
// that the number of electrons follows from an accuracy.
struct Look {
  const char* legend;
  int color;
  io::PlotStyle style;
  bool dashed;
};

Look look_of(const std::string& family) {
  using enum io::PlotStyle;
  if (family == "direct") return {"direct", 0, line_points, false};
  if (family == "direct-accuracy") return {"direct, to an accuracy", 0, line_points, true};
  if (family == "replay") return {"replay", 1, line_points, false};
  if (family == "guided") return {"guided", 6, line_points, false};
  if (family == "accuracy-without-planes") return {"replay, to an accuracy", 1, line_points, true};
  if (family == "accuracy") return {"replay with planes, to an accuracy", 3, line_points, true};
  if (family == "mesh-tolerance") return {"the same without fine detail", 2, points, false};
  if (family == "facet-network") return {"facet network", 5, points, false};
  if (family == "filter-bank") return {"filter banks", 4, points, false};
  return {"slopes, stopping points, flux", 7, points, false};
}

io::PlotPanel panel(const ChartSummary& summary, std::size_t channel, bool prepared) {
  io::PlotPanel panel;
  const std::string& name = summary.points.front().channels[channel].name;
  panel.title = fmt::format("{}, {}", name, prepared ? "all prepared" : "from nothing");
  panel.x = {prepared ? "time of the image alone (s)" : "time with scene, library, training (s)",
             true,
             {}};
  panel.y = {fmt::format("rms error of {} (%)", name), true, {}};
  const std::vector<Place> all = places(summary, channel, prepared);
  const auto [low, high] = std::minmax_element(
      all.begin(), all.end(), [](const Place& a, const Place& b) { return a.error < b.error; });
  panel.y.range = io::PlotAxis::Range{low->error / 1.8, high->error * 1.8};
  std::vector<Look> looks;
  for (const Place& p : all) {
    const Look look = look_of(p.point->family);
    if (!p.point->is_default && std::none_of(looks.begin(), looks.end(), [&](const Look& l) {
          return l.legend == std::string_view(look.legend);
        }))
      looks.push_back(look);
  }
  for (const Look& look : looks) {
    io::PlotSeries series;
    series.name = look.legend;
    series.color = look.color;
    series.style = look.style;
    series.dashed = look.dashed;
    for (const Place& p : all)
      if (!p.point->is_default &&
          look_of(p.point->family).legend == std::string_view(look.legend)) {
        series.x.push_back(p.time);
        series.y.push_back(p.error);
      }
    panel.series.push_back(std::move(series));
  }
  std::vector<Trade> trades;
  for (const Place& p : all) trades.push_back({p.time, p.error});
  io::PlotSeries front = front_series(trades);
  if (!front.x.empty()) panel.series.push_back(std::move(front));
  for (const Place& p : all)
    if (p.point->is_default) panel.notes.push_back({"the scene's default", p.time, p.error});
  for (const ChartChoice& choice : summary.choices)
    for (const Place& p : all)
      if (p.point->id == choice.id)
        panel.notes.push_back(
            {fmt::format("accuracy {}", format_share(choice.accuracy)), p.time, p.error});
  const double floor = summary.reference[channel].error.reference_noise;
  if (floor > 0)
    panel.references.push_back(
        {io::PlotDirection::horizontal, 100 * floor, "noise of the reference"});
  return panel;
}

}  // namespace

io::Plot chart_plot(const ChartJob& job, const ChartSummary& summary) {
  io::Plot plot;
  plot.title =
      fmt::format("{}: time against error", job.scene.title.empty() ? "scene" : job.scene.title);
  const std::size_t channels = summary.points.front().channels.size();
  for (const bool prepared : {false, true})
    for (std::size_t c = 0; c < channels; ++c) {
      plot.panels.push_back(panel(summary, c, prepared));
      // Beside the last panel of the first row.
      plot.panels.back().legend = plot.panels.size() == channels;
    }
  plot.columns = static_cast<int>(channels);
  plot.width_px = 1800;
  return plot;
}

}  // namespace surf::workflow
