// SPDX-License-Identifier: GPL-3.0-or-later
// Gains that are wrong, with the brightness of level ground right: fitted with the surface, and
// held.
#include <cmath>

#include "libsurf/reconstruction/small_scene.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double factor) {
  test::SmallScene scene;
  const double level = scene.sem.gains[0] + scene.sem.offset;  // the model gives 1 there
  scene.sem.gains[0] *= factor;
  scene.sem.offset = level - scene.sem.gains[0];
  std::vector<double> row;
  for (const bool fitted : {true, false}) {
    ReconstructionOptions o;
    o.double_precision = true;
    o.uncertainty = false;
    o.refine_calibration = fitted;
    const Reconstruction r = reconstruct(&scene.afm, &scene.sem, o);
    row.insert(row.end(), {scene.rms_error(r.surface), r.scales.back().sem_residual.deviation,
                           r.warnings.empty() ? 0.0 : 1.0});
    if (fitted) row.push_back(r.gains[0] / 100);
  }
  return row;
}

io::Plot plot(const Table& t) {
  const io::PlotAxis x{"gain given / true gain", false, {}};
  io::Plot out;
  out.title = "Reconstruction from gains that are wrong";
  out.panels = {panel(t, "", x, {"error of the surface, rms (nm)", false, {}},
                      {{"fitted_nm", "fitted with the surface"}, {"held_nm", "held", true}}),
                panel(t, "", x, {"left of the SEM image, in sigma of its noise", false, {}},
                      {{"fitted_left", "fitted"}, {"held_left", "held", true}}),
                panel(t, "", x, {"warned", false, io::PlotAxis::Range{-0.04, 1.04}},
                      {{"fitted_warned", "fitted"}, {"held_warned", "held", true}})};
  return out;
}

}  // namespace

Sweep reconstruction_gains() {
  return {"reconstruction_gains",
          "reconstruction from gains that are wrong by a factor",
          {"factor", "fitted_nm", "fitted_left", "fitted_warned", "gain_fitted", "held_nm",
           "held_left", "held_warned"},
          {0.3, 0.5, 0.7, 0.85, 0.95, 1, 1.05, 1.15, 1.4, 2, 3},
          at,
          1.4,
          0.01,
          plot};
}

}  // namespace surf::limits
