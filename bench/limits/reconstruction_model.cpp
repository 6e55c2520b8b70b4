// SPDX-License-Identifier: GPL-3.0-or-later
// A model that is not the specimen's: walls that brighten with slope otherwise than it says, as of
// another material or energy, and brightness that drifts over the image.
#include <cmath>
#include <functional>

#include "libsurf/reconstruction/small_scene.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

/// `brightness`: the specimen's, relative to level ground, at a pixel where the model says `se`; x,
/// y across the image.
std::vector<double> outcomes(
    const std::function<double(double se, double x, double y)>& brightness) {
  test::SmallScene scene;
  const Grid<double> se = scene.sem.model->predict(scene.truth)[0];
  for (int y = 0; y < se.height(); ++y)
    for (int x = 0; x < se.width(); ++x)
      scene.sem.image.values(x, y) +=
          100 * (brightness(se(x, y), x / double(se.width()), y / double(se.height())) - se(x, y));
  std::vector<double> row;
  for (const bool fitted : {true, false}) {
    ReconstructionOptions o;
    o.double_precision = true;
    o.refine_calibration = fitted;
    const Reconstruction r = reconstruct(&scene.afm, &scene.sem, o);
    double within = 0;
    for (std::size_t i = 0; i < r.deviation_nm.size(); ++i)
      within += std::abs(r.surface.z_nm.data()[i] - scene.truth.z_nm.data()[i]) <
                r.deviation_nm.data()[i];
    row.insert(row.end(), {scene.rms_error(r.surface), r.scales.back().sem_residual.deviation,
                           within / static_cast<double>(r.deviation_nm.size()),
                           r.warnings.empty() ? 0.0 : 1.0});
  }
  // The scan alone, on the same samples: a gain of 0 leaves the SEM image without a say.
  scene.sem.gains = {0};
  ReconstructionOptions o;
  o.double_precision = true;
  o.uncertainty = o.refine_transform = o.refine_calibration = false;
  row.push_back(scene.rms_error(reconstruct(&scene.afm, &scene.sem, o).surface));
  return row;
}

std::vector<double> at_power(double power) {
  return outcomes([&](double se, double, double) { return std::pow(se, power); });
}

std::vector<double> at_drift(double drift) {
  return outcomes(
      [&](double se, double x, double y) { return se * (1 + drift * std::sin(9 * x + 3 * y)); });
}

std::vector<std::string> columns(const char* first) {
  return {first,     "fitted_nm", "fitted_left", "fitted_within", "fitted_warned",
          "held_nm", "held_left", "held_within", "held_warned",   "afm_nm"};
}

io::Plot plot(const Table& t, const std::string& title, const io::PlotAxis& x) {
  io::Plot out;
  out.title = title;
  out.panels = {
      panel(t, "", x, {"error of the surface, rms (nm)", false, {}},
            {{"fitted_nm", "gains fitted with the surface"},
             {"held_nm", "gains held"},
             {"afm_nm", "AFM alone", true}}),
      panel(t, "", x, {"share of heights within one deviation", false, io::PlotAxis::Range{0, 1}},
            {{"fitted_within", "gains fitted"}, {"held_within", "gains held"}}),
      panel(t, "", x, {"warned", false, io::PlotAxis::Range{-0.04, 1.04}},
            {{"fitted_warned", "gains fitted"}, {"held_warned", "gains held", true}})};
  return out;
}

}  // namespace

Sweep reconstruction_material() {
  return {"reconstruction_material",
          "reconstruction with a model of another material or energy",
          columns("power"),
          {0.5, 0.7, 0.8, 0.9, 0.95, 1, 1.05, 1.1, 1.2, 1.3, 1.5},
          at_power,
          1.1,
          0.05,
          [](const Table& t) {
            return plot(t, "Walls that brighten otherwise than the model says",
                        {"true brightness is the model's to the power of", false, {}});
          }};
}

Sweep reconstruction_drift() {
  return {"reconstruction_drift",
          "reconstruction of an image whose brightness drifts",
          columns("drift"),
          {0, 0.005, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3},
          at_drift,
          0.05,
          0.05,
          [](const Table& t) {
            return plot(t, "Brightness that drifts over the image",
                        {"amplitude of the drift, share of brightness", false, {}});
          }};
}

}  // namespace surf::limits
