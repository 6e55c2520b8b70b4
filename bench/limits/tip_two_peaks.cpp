// SPDX-License-Identifier: GPL-3.0-or-later
// Tips with a second peak, from as high as the first to 6 nm shorter: which of the two peaks a
// blind tip finds, and what the sweep says of it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "surf/afm/tip_shapes.h"
#include "surf/afm/tip_sweep.h"
#include "sweeps.h"
#include "tip_scans.h"

namespace surf::limits {
namespace {

constexpr double sigma_nm = 0.1, depth_nm = 8;
constexpr int size_px = 17, pixels = 96, apart_px = 6;

Tip two_peaks(double shorter_nm) {
  Tip tip = parabolic_tip(1.5, {1, 1, size_px, size_px});
  const Tip one = tip;
  for (int y = 0; y < size_px; ++y)
    for (int x = apart_px; x < size_px; ++x)
      tip.z_nm(x, y) = std::max(tip.z_nm(x, y), one.z_nm(x - apart_px, y) - shorter_nm);
  return tip;
}

BlindTipOptions options(double threshold_nm, double tolerance_nm) {
  BlindTipOptions o;
  o.width = o.height = size_px;
  o.threshold_nm = threshold_nm;
  o.apex_tolerance_nm = tolerance_nm;
  return o;
}

std::vector<double> at(double shorter_nm) {
  const Tip truth = two_peaks(shorter_nm);
  const HeightField scan = scan_of_spikes(truth, pixels, sigma_nm, 4);
  TipSweepOptions o;
  o.blind = options(0, 0);
  o.noise = {0, sigma_nm * sigma_nm};
  o.thresholds = 20;
  const TipSweep sweep = sweep_tips({scan}, o);
  const SweptTip& chosen = sweep.curve[sweep.chosen];
  const double t = 3 * sigma_nm;
  const auto [classical, ignored] = blind_tip({scan}, options(t, 0));
  const int second = truth.apex_x + apart_px, mirrored = truth.apex_x - apart_px;
  const auto depth = [&](const Tip& tip, int x) { return -tip.z_nm(x, tip.apex_y); };
  return {error_of(chosen.tip, truth, depth_nm).rms_nm,
          error_of(classical, truth, depth_nm).rms_nm,
          depth(chosen.tip, second),
          depth(classical, second),
          depth(chosen.tip, mirrored),
          depth(truth, mirrored),
          static_cast<double>(sweep.verdict),
          chosen.excess()};
}

io::Plot plot(const Table& t) {
  io::PlotPanel peaks =
      panel(t, "", {"second peak shorter by (nm)", false, {}}, {"its depth (nm)", false, {}},
            {{"shorter_nm", "the truth", true},
             {"sweep_second_nm", "sweep"},
             {"no_tolerance_second_nm", "no apex tolerance"},
             {"sweep_mirrored_nm", "other side (12 nm)"}});
  for (const auto& row : t.rows)
    if (row[7] == static_cast<double>(TipSweepVerdict::none))
      peaks.notes.push_back({"none fits", row[0], row[5]});
  io::Plot out;
  out.title = "A tip with two peaks";
  out.panels = {peaks};
  return out;
}

}  // namespace

Sweep tip_two_peaks() {
  return {"tip_two_peaks",
          "blind tips where the true one has two peaks",
          {"shorter_nm", "sweep_rms_nm", "no_tolerance_rms_nm", "sweep_second_nm",
           "no_tolerance_second_nm", "sweep_mirrored_nm", "true_mirrored_nm", "verdict", "excess"},
          {0, 0.1, 0.2, 0.3, 0.5, 1, 2, 3, 4, 6},
          at,
          0,
          1e-4,
          plot};
}

}  // namespace surf::limits
