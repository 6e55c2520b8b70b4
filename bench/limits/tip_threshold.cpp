// SPDX-License-Identifier: GPL-3.0-or-later
// Blind tips at thresholds from 0 to 6 standard deviations of the noise, and what the sweep of
// thresholds finds by itself in the same scans.
#include <cmath>
#include <vector>

#include "surf/afm/tip_shapes.h"
#include "surf/afm/tip_sweep.h"
#include "sweeps.h"
#include "tip_scans.h"

namespace surf::limits {
namespace {

constexpr double sigma_nm = 0.1, depth_nm = 5;
constexpr int size_px = 13, pixels = 96, scans = 4;

Tip truth() { return parabolic_tip(4, {1, 1, size_px, size_px}); }

HeightField scan(int number) {
  return scan_of_spikes(truth(), pixels, sigma_nm, static_cast<std::uint64_t>(4 + number));
}

BlindTipOptions options(double threshold_nm, double tolerance_nm) {
  BlindTipOptions o;
  o.width = o.height = size_px;
  o.threshold_nm = threshold_nm;
  o.apex_tolerance_nm = tolerance_nm;
  return o;
}

struct Found {
  double threshold_sigma = 0, rms_nm = 0;
};

/// What `semsurf tip` finds, mean of the scans.
Found by_itself() {
  static const Found found = [] {
    Found f;
    for (int k = 0; k < scans; ++k) {
      TipSweepOptions o;
      o.blind = options(0, 0);
      o.noise = {0, sigma_nm * sigma_nm};
      const TipSweep sweep = sweep_tips({scan(k)}, o);
      const SweptTip& chosen = sweep.curve[sweep.chosen];
      f.threshold_sigma += chosen.threshold_nm / sigma_nm / scans;
      f.rms_nm += error_of(chosen.tip, truth(), depth_nm).rms_nm / scans;
    }
    return f;
  }();
  return found;
}

std::vector<double> at(double threshold_sigma) {
  TipError with, without;
  for (int k = 0; k < scans; ++k) {
    const double t = threshold_sigma * sigma_nm;
    const TipError a = error_of(blind_tip({scan(k)}, options(t, t)).tip, truth(), depth_nm);
    const TipError b = error_of(blind_tip({scan(k)}, options(t, 0)).tip, truth(), depth_nm);
    with.rms_nm += a.rms_nm / scans, with.mean_nm += a.mean_nm / scans;
    without.rms_nm += b.rms_nm / scans, without.mean_nm += b.mean_nm / scans;
  }
  const Found found = by_itself();
  return {with.rms_nm,     with.mean_nm, without.rms_nm,
          without.mean_nm, found.rms_nm, found.threshold_sigma};
}

io::Plot plot(const Table& t) {
  io::PlotPanel error = panel(t, "", {"threshold (standard deviations of the noise)", false, {}},
                              {"mean error: below 0 too sharp (nm)", false, {}},
                              {{"mean_nm", "apex tolerance = threshold"},
                               {"no_tolerance_mean_nm", "no apex tolerance (1997)"}});
  error.references = {{io::PlotDirection::horizontal, 0, ""},
                      {io::PlotDirection::vertical, t.column("sweep_threshold_sigma").front(),
                       "chosen by the sweep"}};
  io::Plot out;
  out.title = "Blind tips of 4 nm radius, noise 0.1 nm";
  out.panels = {error};
  return out;
}

}  // namespace

Sweep tip_threshold() {
  return {"tip_threshold",
          "blind tips at thresholds from 0 to 6 standard deviations of the noise",
          {"threshold_sigma", "rms_nm", "mean_nm", "no_tolerance_rms_nm", "no_tolerance_mean_nm",
           "sweep_rms_nm", "sweep_threshold_sigma"},
          {0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6},
          at,
          2,
          1e-4,
          plot};
}

}  // namespace surf::limits
