// SPDX-License-Identifier: GPL-3.0-or-later
// A model of 1 keV and silicon on images of another energy or another density: what it costs
// whoever says the wrong one, before and after gain and offset are fitted as calibration does.
#include <vector>

#include "small_models.h"
#include "surf/core/error.h"
#include "surf/sem/calibration.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

struct Off {
  double error, bias, calibrated, warned;
};

Off judge(const TrainingImage& truth) {
  const Grid<double> predicted = make_model(gentle_bank())->predict(truth.field).front();
  CalibrationImages images;
  images.real = Grid<double>(predicted.width(), predicted.height());
  double mean = 0, mean_predicted = 0;
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    images.real.data()[k] = truth.images.front().data()[k];
    mean += images.real.data()[k], mean_predicted += predicted.data()[k];
  }
  images.channels = {"SE"};
  images.simulated = {predicted};
  const Calibration c = calibrate(images);
  return {error_beyond_noise(predicted, truth), mean_predicted / mean - 1,
          error_beyond_noise(calibrated_image(c, images.simulated), truth),
          static_cast<double>(!c.warnings.empty())};
}

std::vector<double> at(double ratio) {
  const HeightField surface = rough(3, 15, 11);
  const Off energy = judge(monte_carlo(surface, {.energy_ev = 1000 * ratio}));
  const Off density = judge(monte_carlo(surface, {.density = ratio}));
  double refused = 0;
  try {
    check_conditions(gentle_bank().scope, {0, "Si", 1000 * ratio, 0});
  } catch (const UsageError&) {
    refused = 1;
  }
  return {refused,       energy.error, energy.bias,        energy.calibrated, energy.warned,
          density.error, density.bias, density.calibrated, density.warned};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "A model of Si, 1 keV, on other energies and densities";
  out.panels = {panel(t, "", {"energy or density over the model's", true, {{0.75, 1.2}}},
                      {"rms error of SE, relative", true, {}},
                      {{"energy_error", "energy (refused if told)"},
                       {"energy_calibrated_error", "energy, gain and offset fitted", true},
                       {"density_error", "density"},
                       {"density_calibrated_error", "density, gain and offset fitted", true}})};
  return out;
}

}  // namespace

Sweep wrong_energy() {
  return {"wrong_energy",
          "a model on images of another energy or density than said",
          {"ratio", "refused", "energy_error", "energy_bias", "energy_calibrated_error",
           "energy_warned", "density_error", "density_bias", "density_calibrated_error",
           "density_warned"},
          {0.8, 0.9, 1, 1.1},
          at,
          0.9,
          0.02,
          plot};
}

}  // namespace surf::limits
