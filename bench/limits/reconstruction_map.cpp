// SPDX-License-Identifier: GPL-3.0-or-later
// A map between the images that is off: fitted further with the surface, and held.
#include <cmath>

#include "libsurf/reconstruction/small_scene.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double off_px) {
  test::SmallScene scene;
  const Affine truth = scene.sem.sem_to_afm;
  const double off_nm = off_px * scene.sem.image.pitch_x_nm;
  scene.sem.sem_to_afm.x0 += 0.8 * off_nm;
  scene.sem.sem_to_afm.y0 -= 0.6 * off_nm;
  std::vector<double> row;
  for (const bool fitted : {true, false}) {
    ReconstructionOptions o;
    o.double_precision = true;
    o.uncertainty = false;
    o.refine_transform = fitted;
    const Reconstruction r = reconstruct(&scene.afm, &scene.sem, o);
    row.insert(row.end(), {scene.rms_error(r.surface), r.scales.back().sem_residual.deviation,
                           r.warnings.empty() ? 0.0 : 1.0});
    const Point2 is = r.sem_to_afm({0, 0}), should = truth({0, 0});
    if (fitted)
      row.push_back(std::hypot(is.x - should.x, is.y - should.y) / scene.sem.image.pitch_x_nm);
    if (!fitted) row.push_back(scene.rms_error(r.start));
  }
  return row;
}

io::Plot plot(const Table& t) {
  const io::PlotAxis x{"map off by (SEM pixels)", false, {}};
  io::Plot out;
  out.title = "Reconstruction from a map between the images that is off";
  out.panels = {
      panel(t, "", x, {"error of the surface, rms (nm)", false, {}},
            {{"fitted_nm", "map fitted with the surface"},
             {"held_nm", "map held"},
             {"start_nm", "eroded scan", true}}),
      panel(t, "", x, {"map off at the end (SEM pixels)", false, {}}, {{"map_off_px", "fitted"}}),
      panel(t, "", x, {"warned", false, io::PlotAxis::Range{-0.04, 1.04}},
            {{"fitted_warned", "fitted"}, {"held_warned", "held", true}})};
  return out;
}

}  // namespace

Sweep reconstruction_map() {
  return {"reconstruction_map",
          "reconstruction from a start far away: the map between the images is off",
          {"off_px", "fitted_nm", "fitted_left", "fitted_warned", "map_off_px", "held_nm",
           "held_left", "held_warned", "start_nm"},
          {0, 0.25, 0.5, 1, 2, 3, 4, 6, 8, 12, 16},
          at,
          8,
          0.1,
          plot};
}

}  // namespace surf::limits
