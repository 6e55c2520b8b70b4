// SPDX-License-Identifier: GPL-3.0-or-later
#include "tip_plot.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace surf::cli {
namespace {

using io::PlotDirection;
using io::PlotPanel;
using io::PlotSeries;
using io::PlotStyle;

// Along a row or column through the apex, of the physical tip: (x, z) -> (-x, -z).
PlotSeries profile(const Tip& tip, bool along_x, const Grid<double>* standard_error,
                   const char* name) {
  PlotSeries s;
  s.name = name;
  s.style = PlotStyle::line_points;
  const int n = along_x ? tip.z_nm.width() : tip.z_nm.height();
  for (int k = n - 1; k >= 0; --k) {
    const int i = along_x ? k : tip.apex_x, j = along_x ? tip.apex_y : k;
    if (!std::isfinite(tip.z_nm(i, j))) continue;
    if (standard_error && !std::isfinite((*standard_error)(i, j))) continue;
    s.x.push_back(
        -(along_x ? (i - tip.apex_x) * tip.pitch_x_nm : (j - tip.apex_y) * tip.pitch_y_nm));
    s.y.push_back(-tip.z_nm(i, j));
    if (standard_error) s.y_error.push_back((*standard_error)(i, j));
  }
  return s;
}

PlotPanel profiles(const Tip& tip, const Grid<double>* standard_error = nullptr) {
  PlotPanel p;
  p.title =
      standard_error ? "the tip through its apex, where it touched" : "the tip through its apex";
  p.x.label = "from the apex (nm)";
  p.y.label = "height (nm)";
  p.series = {profile(tip, true, standard_error, "along x"),
              profile(tip, false, standard_error, "along y")};
  return p;
}

PlotSeries curve(const char* name, PlotStyle style = PlotStyle::line_points) {
  PlotSeries s;
  s.name = name;
  s.style = style;
  return s;
}

}  // namespace

io::Plot tip_plot(const Tip& tip) {
  io::Plot plot;
  plot.title = "Tip";
  plot.panels = {profiles(tip)};
  return plot;
}

io::Plot tip_plot(const TipSweep& sweep) {
  io::Plot plot;
  plot.title = "Blind tip reconstruction: which threshold?";
  PlotPanel volume, residual;
  volume.title = "volume of the tip";
  volume.y.label = "volume (nm^3)";
  residual.title = "what the opened scan lacks";
  residual.y = {"times what the noise explains", true, {}};
  volume.x.label = residual.x.label = "threshold and apex tolerance (nm)";
  PlotSeries v = curve("volume"), rms = curve("root mean square"), peaks = curve("largest 0.1 %");
  for (const SweptTip& t : sweep.curve) {
    v.x.push_back(t.threshold_nm);
    v.y.push_back(t.volume_nm3);
    if (!(t.residual_nm > 0 && t.expected_nm > 0 && t.peaks_nm > 0 && t.expected_peaks_nm > 0))
      continue;
    rms.x.push_back(t.threshold_nm);
    rms.y.push_back(t.residual_nm / t.expected_nm);
    peaks.x.push_back(t.threshold_nm);
    peaks.y.push_back(t.peaks_nm / t.expected_peaks_nm);
  }
  const SweptTip& chosen = sweep.curve[sweep.chosen];
  volume.series = {v};
  residual.series = {rms, peaks};
  for (PlotPanel* p : {&volume, &residual})
    p->references.push_back({PlotDirection::vertical, chosen.threshold_nm, "chosen"});
  if (sweep.jump != sweep.chosen)
    volume.references.push_back(
        {PlotDirection::vertical, sweep.curve[sweep.jump].threshold_nm, "above the jump"});
  plot.panels.push_back(volume);
  if (!rms.x.empty()) plot.panels.push_back(residual);
  plot.panels.push_back(profiles(chosen.tip));
  plot.columns = static_cast<int>(plot.panels.size());
  return plot;
}

io::Plot tip_plot(const Tip& tip, const BestTipSummary& summary) {
  io::Plot plot;
  plot.title = "The most likely tip";
  PlotPanel risk;
  double tolerance = 0;
  risk.title = "fits from outer bounds";
  risk.x.label = "threshold of the bound (nm)";
  risk.y = {"per pixel", true, {}};
  for (const TipCandidate& c : summary.candidates) {
    if (risk.series.empty() || c.tolerance != tolerance) {  // another family of bounds
      tolerance = c.tolerance;
      const int color = static_cast<int>(risk.series.size() / 2);
      for (const char* what : {"risk", "misfit"}) {
        PlotSeries s = curve("");
        s.name = fmt::format("{}, tolerance {:g} x threshold", what, tolerance);
        s.color = color;
        s.dashed = std::string(what) == "misfit";
        risk.series.push_back(std::move(s));
      }
    }
    PlotSeries* last = &risk.series[risk.series.size() - 2];
    last[0].x.push_back(c.threshold_nm);
    last[0].y.push_back(c.risk);
    last[1].x.push_back(c.threshold_nm);
    last[1].y.push_back(c.misfit);
  }
  risk.references.push_back({PlotDirection::vertical, summary.chosen.threshold_nm, "chosen"});
  plot.panels = {risk, profiles(tip, &summary.standard_error_nm)};
  return plot;
}

}  // namespace surf::cli
