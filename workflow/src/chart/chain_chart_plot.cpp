// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain_chart_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "plot_parts.h"
#include "thesis_points.h"

namespace surf::workflow {
namespace {

// A logarithmic axis cannot show 0.
constexpr double least_s = 1e-5, least_nm = 1e-4;

struct Look {
  const char* legend;
  int color;
};

Look look_of(std::string_view family) {
  if (family == "correlation") return {"start, correlation", 0};
  if (family == "mutual-information") return {"start, mutual information", 1};
  if (family == "landmarks") return {"landmarks, refined", 2};
  if (family == "landmarks-only") return {"landmarks alone", 3};
  if (family == "search") return {"search, no start", 4};
  if (family == "erosion") return {"AFM, eroded", 7};
  if (family == "afm") return {"AFM alone", 2};
  if (family == "sem") return {"SEM alone", 3};
  if (family == "gauss-newton") return {"both, Gauss-Newton", 0};
  if (family == "conjugate-gradients") return {"both, conjugate gradients", 1};
  if (family == "lbfgs") return {"both, L-BFGS", 4};
  return {"both, nothing known", 5};
}

io::PlotSeries series_of(std::string_view family, io::PlotStyle style) {
  const Look look = look_of(family);
  io::PlotSeries series;
  series.name = look.legend;
  series.color = look.color;
  series.style = style;
  return series;
}

std::vector<std::string> families_of(const auto& points) {
  std::vector<std::string> out;
  for (const auto& p : points)
    if (std::ranges::find(out, p.family) == out.end()) out.push_back(p.family);
  return out;
}

// A way that never succeeds has a range of 0. A way that needs no start has no range, and gets a
// line at its time.
io::PlotPanel range_panel(const ChainChartSummary& summary,
                          std::optional<double> CaptureRange::*range, bool CaptureRange::*open,
                          double RegistrationPoint::*offset, const char* unit) {
  io::PlotPanel panel;
  panel.title = fmt::format("Capture range, {}", unit);
  panel.x = {"time of one registration (s)", true, {}};
  panel.y = {fmt::format("largest offset with 90 % success ({})", unit), false, {}};
  panel.legend = false;
  for (const CaptureRange& r : summary.ranges) {
    const bool tried = std::ranges::any_of(summary.registrations, [&](const RegistrationPoint& p) {
      return p.family == r.family && !p.any_start && p.*offset > 0;
    });
    const double time = std::max(least_s, r.median_s);
    if (r.any_start) {
      panel.references.push_back({io::PlotDirection::vertical, time, "search, no start"});
      continue;
    }
    if (!tried) continue;
    io::PlotSeries series = series_of(r.family, io::PlotStyle::points);
    series.x = {time};
    series.y = {(r.*range).value_or(0)};
    if (r.*open) panel.notes.push_back({"or more", time, series.y[0]});
    panel.series.push_back(std::move(series));
  }
  return panel;
}

io::PlotPanel success_panel(const ChainChartSummary& summary, double RegistrationPoint::*offset,
                            const char* unit) {
  io::PlotPanel panel;
  panel.title = "Success";
  panel.x = {fmt::format("offset of the start or of each landmark ({})", unit), true, {}};
  panel.y = {fmt::format("verified and within {:g} px (%)", right_px), false,
             io::PlotAxis::Range{-5, 105}};
  for (const std::string& family : families_of(summary.registrations)) {
    io::PlotSeries series = series_of(family, io::PlotStyle::line_points);
    for (const RegistrationPoint& p : summary.registrations)
      if (p.family == family) {
        if (p.any_start)
          panel.references.push_back(
              {io::PlotDirection::horizontal, 100 * p.share(), "search, no start"});
        else if (p.*offset > 0) {
          series.x.push_back(p.*offset);
          series.y.push_back(100 * p.share());
        }
      }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

io::PlotPanel error_panel(const ChainChartSummary& summary, bool relative) {
  io::PlotPanel panel;
  panel.title = relative ? "Beside the thesis" : "Against the truth";
  panel.x = {"time, with what is found before (s)", true, {}};
  panel.y = {relative ? "rms error over the eroded scan's" : "rms error (nm)", true, {}};
  panel.legend = relative;
  const double unit = relative ? summary.eroded_nm : 1;
  std::vector<Trade> trades;
  for (const ReconstructionPoint& p : summary.reconstructions) {
    io::PlotSeries series = series_of(
        p.family, p.steps.size() > 1 ? io::PlotStyle::line_points : io::PlotStyle::points);
    if (std::ranges::any_of(panel.series,
                            // One legend entry for all settings.
                            [&](const io::PlotSeries& s) { return s.name == series.name; }))
      series.name.clear();
    for (const ReconstructionStep& s : p.steps) {
      series.x.push_back(std::max(least_s, p.preparation_s + s.run_s));
      series.y.push_back(std::max(least_nm, s.rms_nm) / unit);
    }
    trades.push_back({series.x.back(), series.y.back()});
    if (p.is_default)
      panel.notes.push_back({"semsurf reconstruct", series.x.back(), series.y.back()});
    panel.series.push_back(std::move(series));
  }
  panel.series.push_back(front_series(trades));
  if (summary.floor_nm > 0)
    panel.references.push_back(
        {io::PlotDirection::horizontal, summary.floor_nm / unit, "floor: noise and prior"});
  if (!relative) {
    panel.references.push_back({io::PlotDirection::horizontal, summary.eroded_nm, "eroded scan"});
    return panel;
  }
  for (const bool real : {false, true}) {
    io::PlotSeries series;
    series.name = real ? "thesis, real specimens *" : "thesis, synthetic *";
    series.style = io::PlotStyle::points;
    series.color = real ? 6 : 5;
    for (const ThesisPoint& t : thesis_points)
      if (t.real == real) {
        series.x.push_back(3600 * t.hours);
        series.y.push_back(t.ratio());
      }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

io::Plot registration_plot(const ChainChartSummary& summary) {
  io::Plot plot;
  plot.title = fmt::format("{}: how far off registration may begin ({} draws each)", summary.sample,
                           summary.registrations.front().draws);
  const auto drawn = [](const io::PlotPanel& p) { return !p.series.empty(); };
  for (io::PlotPanel& panel : std::vector<io::PlotPanel>{
           range_panel(summary, &CaptureRange::px, &CaptureRange::px_open,
                       &RegistrationPoint::offset_px, "SEM pixels"),
           success_panel(summary, &RegistrationPoint::offset_px, "SEM pixels"),
           range_panel(summary, &CaptureRange::deg, &CaptureRange::deg_open,
                       &RegistrationPoint::offset_deg, "degrees"),
           success_panel(summary, &RegistrationPoint::offset_deg, "degrees")})
    if (drawn(panel)) plot.panels.push_back(std::move(panel));
  if (plot.panels.empty()) {  // only the search was run: show its success against its time
    io::PlotPanel panel;
    panel.x = {"time of one registration (s)", true, {}};
    panel.y = {fmt::format("verified and within {:g} px (%)", right_px), false,
               io::PlotAxis::Range{-5, 105}};
    const RegistrationPoint& p = summary.registrations.front();
    io::PlotSeries series = series_of(p.family, io::PlotStyle::points);
    series.x = {std::max(least_s, p.median_s)};
    series.y = {100 * p.share()};
    panel.series.push_back(std::move(series));
    plot.panels.push_back(std::move(panel));
  }
  plot.columns = std::min<int>(2, static_cast<int>(plot.panels.size()));
  plot.width_px = 1600;
  return plot;
}

io::Plot reconstruction_plot(const ChainChartSummary& summary) {
  io::Plot plot;
  plot.title =
      fmt::format("{}: time against error of reconstructions\n* {}", summary.sample, thesis_source);
  plot.panels = {error_panel(summary, false), error_panel(summary, true)};
  plot.columns = 2;
  plot.width_px = 1800;
  return plot;
}

}  // namespace surf::workflow
