// SPDX-License-Identifier: GPL-3.0-or-later
// The schedule of scales: how smooth the last one leaves the surface, and how coarse the first one
// begins.
#include <cmath>

#include "libsurf/reconstruction/small_scene.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

struct End {
  double error_nm = 0, sem_deviation = 0, warned = 0;
};

End end_of(const test::SmallScene& scene, ReconstructionMethod method,
           std::vector<double> scales_px) {
  ReconstructionOptions o;
  o.double_precision = true;
  o.method = method;
  o.scales_px = std::move(scales_px);
  o.uncertainty = false;
  if (method != ReconstructionMethod::gauss_newton) o.iterations = 60;
  const Reconstruction r = reconstruct(&scene.afm, &scene.sem, o);
  return {scene.rms_error(r.surface), r.scales.back().sem_residual.deviation,
          r.warnings.empty() ? 0.0 : 1.0};
}

std::vector<double> at_last(double scale_px) {
  const test::SmallScene scene;
  const End newton = end_of(scene, ReconstructionMethod::gauss_newton, {scale_px});
  std::vector<double> falling;  // halved from 8 on
  for (double s = 8; s > 1.01 * scale_px; s /= 2) falling.push_back(s);
  falling.push_back(scale_px);
  const End descent = end_of(scene, ReconstructionMethod::lbfgs, falling);
  return {newton.error_nm,  newton.sem_deviation,  newton.warned,
          descent.error_nm, descent.sem_deviation, descent.warned};
}

std::vector<double> at_first(double scale_px) {
  const test::SmallScene scene;
  std::vector<double> newton{scale_px};
  if (scale_px > 1.4) newton.push_back(1.4);
  std::vector<double> halved, jump{scale_px};
  for (double s = scale_px; s > 0.75; s /= 2) halved.push_back(s);
  halved.push_back(0.5);
  if (scale_px > 0.5) jump.push_back(0.5);
  else halved = {scale_px};
  const End n = end_of(scene, ReconstructionMethod::gauss_newton, newton);
  const End h = end_of(scene, ReconstructionMethod::lbfgs, halved);
  const End j = end_of(scene, ReconstructionMethod::lbfgs, jump);
  return {n.error_nm, n.warned, h.error_nm, h.warned, j.error_nm, j.warned};
}

io::Plot plot_last(const Table& t) {
  const io::PlotAxis x{"last scale (pixels)", true, {}};
  io::Plot out;
  out.title = "Where the schedule of scales ends";
  out.panels = {panel(t, "", x, {"error of the surface, rms (nm)", true, {}},
                      {{"newton_nm", "Gauss-Newton"}, {"lbfgs_nm", "L-BFGS, halved from 8", true}}),
                panel(t, "", x, {"left of the SEM image, in sigma of its noise", false, {}},
                      {{"newton_left", "Gauss-Newton"}, {"lbfgs_left", "L-BFGS", true}}),
                panel(t, "", x, {"warned", false, io::PlotAxis::Range{-0.04, 1.04}},
                      {{"newton_warned", "Gauss-Newton"}, {"lbfgs_warned", "L-BFGS", true}})};
  out.panels[0].references.push_back({io::PlotDirection::vertical, 1.4, "default of Gauss-Newton"});
  return out;
}

io::Plot plot_first(const Table& t) {
  const io::PlotAxis x{"first scale (pixels)", true, {}};
  io::Plot out;
  out.title = "Where the schedule of scales begins";
  out.panels = {panel(t, "", x, {"error of the surface, rms (nm)", true, {}},
                      {{"newton_nm", "Gauss-Newton, then 1.4"},
                       {"halved_nm", "L-BFGS, halved to 0.5"},
                       {"jump_nm", "L-BFGS, then 0.5 at once", true}}),
                panel(t, "", x, {"warned", false, io::PlotAxis::Range{-0.04, 1.04}},
                      {{"newton_warned", "Gauss-Newton"},
                       {"halved_warned", "L-BFGS, halved"},
                       {"jump_warned", "L-BFGS, at once", true}})};
  return out;
}

}  // namespace

Sweep reconstruction_last_scale() {
  return {"reconstruction_last_scale",
          "reconstruction with a last scale that is too fine or too coarse",
          {"scale_px", "newton_nm", "newton_left", "newton_warned", "lbfgs_nm", "lbfgs_left",
           "lbfgs_warned"},
          {0.25, 0.5, 0.7, 1, 1.4, 2, 3, 5, 8, 15, 30},
          at_last,
          5,
          0.03,
          plot_last};
}

Sweep reconstruction_first_scale() {
  return {"reconstruction_first_scale",
          "reconstruction with a first scale that is too fine or too coarse",
          {"scale_px", "newton_nm", "newton_warned", "halved_nm", "halved_warned", "jump_nm",
           "jump_warned"},
          {0.5, 1, 2, 4, 8, 15, 30, 60},
          at_first,
          30,
          0.15,
          plot_first};
}

}  // namespace surf::limits
