// SPDX-License-Identifier: GPL-3.0-or-later
// Noise of the SEM image that is told wrong by a factor, as where the grey levels of an electron
// are not known; and the noise that a first reconstruction leaves.
#include <cmath>

#include "libsurf/reconstruction/small_scene.h"
#include "surf/sem/noise_of_residuals.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

/// Error, share of heights within one deviation, what is left of the SEM image, and whether that is
/// said.
std::vector<double> outcome(const test::SmallScene& scene) {
  ReconstructionOptions o;
  o.double_precision = true;
  const Reconstruction r = reconstruct(&scene.afm, &scene.sem, o);
  double within = 0;
  for (std::size_t i = 0; i < r.deviation_nm.size(); ++i)
    within +=
        std::abs(r.surface.z_nm.data()[i] - scene.truth.z_nm.data()[i]) < r.deviation_nm.data()[i];
  return {scene.rms_error(r.surface), within / static_cast<double>(r.deviation_nm.size()),
          r.scales.back().sem_residual.deviation, r.warnings.empty() ? 0.0 : 1.0};
}

std::vector<double> at(double factor) {
  test::SmallScene scene;
  SemNoise& noise = scene.sem.noise;
  noise = {factor * noise.slope, factor * noise.intercept, factor * noise.least_variance};
  std::vector<double> row = outcome(scene);
  // As the command does where no noise is given: from what a coarse reconstruction leaves.
  ReconstructionOptions coarse;
  coarse.double_precision = true;
  coarse.scales_px = {5};
  coarse.iterations = 12;
  coarse.uncertainty = false;
  const Reconstruction first = reconstruct(&scene.afm, &scene.sem, coarse);
  noise = noise_of_residuals(scene.sem.image.values, first.simulated_sem);
  for (const double v : outcome(scene)) row.push_back(v);
  return row;
}

io::Plot plot(const Table& t) {
  const io::PlotAxis x{"variance told / true variance", true, {}};
  io::Plot out;
  out.title = "Reconstruction with noise of the SEM image told wrong";
  out.panels = {
      panel(t, "", x, {"error of the surface, rms (nm)", false, {}},
            {{"told_nm", "as told"}, {"found_nm", "found from residuals", true}}),
      panel(t, "", x, {"share of heights within one deviation", false, io::PlotAxis::Range{0, 1}},
            {{"told_within", "as told"}, {"found_within", "found from residuals", true}}),
      panel(t, "", x, {"warned", false, io::PlotAxis::Range{-0.04, 1.04}},
            {{"told_warned", "as told"}, {"found_warned", "found from residuals", true}})};
  return out;
}

}  // namespace

Sweep reconstruction_sem_noise() {
  return {"reconstruction_sem_noise",
          "reconstruction with noise of the SEM image told wrong by a factor",
          {"factor", "told_nm", "told_within", "told_left", "told_warned", "found_nm",
           "found_within", "found_left", "found_warned"},
          {0.01, 0.03, 0.1, 0.3, 0.6, 1, 1.6, 3, 10, 30, 100},
          at,
          10,
          0.01,
          plot};
}

}  // namespace surf::limits
