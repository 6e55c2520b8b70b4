// SPDX-License-Identifier: GPL-3.0-or-later
// A detector that sees more of the electrons that leave towards +x, against models that do not
// change as the surface is turned (thesis, 10.6).
#include <cmath>
#include <vector>

#include "small_models.h"
#include "surf/mesh/shapes.h"
#include "surf/sem/calibration.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

/// SE, and SE that leave towards +x alone.
const TrainingImage& line_image() {
  static const TrainingImage image = [] {
    std::vector<mc::Detector> detectors = mc::default_detectors();
    detectors.pop_back();
    for (mc::Detector& d : mc::parse_detectors("side:name=half,axis=90deg/0deg", "limits"))
      detectors.push_back(d);
    return monte_carlo(make_line({141, 45, 3}, 15, 45, 15),
                       {.electrons = 120, .detectors = detectors});
  }();
  return image;
}

/// The part of the signal that goes with x: how much brighter the wall towards +x is than the
/// other, over their mean.
double lopsided(const Grid<double>& image) {
  const HeightField& field = line_image().field;
  double right = 0, left = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double at_nm = std::abs(field.x_nm(x));
      if (at_nm > 22.5 && at_nm < 37.5) (field.x_nm(x) > 0 ? right : left) += image(x, y);
    }
  return 2 * (right - left) / (right + left);
}

std::vector<double> at(double share) {
  const TrainingImage& all = line_image();
  TrainingImage signal = all;
  signal.images.resize(1), signal.standard_errors.resize(1);
  CalibrationImages images;
  images.real = Grid<double>(all.field.z_nm.width(), all.field.z_nm.height());
  for (std::size_t k = 0; k < images.real.size(); ++k) {
    // (1 - share) of SE, and the rest from one side, twice as sensitive: on a plain as bright as
    // before.
    const double mixed =
        (1 - share) * all.images[0].data()[k] + 2 * share * all.images[1].data()[k];
    const double error = std::hypot((1 - share) * all.standard_errors[0].data()[k],
                                    2 * share * all.standard_errors[1].data()[k]);
    signal.images[0].data()[k] = static_cast<float>(mixed);
    signal.standard_errors[0].data()[k] = static_cast<float>(error);
    images.real.data()[k] = mixed;
  }
  const Grid<double> predicted = make_model(gentle_bank())->predict(all.field).front();
  images.channels = {"SE"};
  images.simulated = {predicted};
  const Calibration c = calibrate(images);
  return {error_beyond_noise(calibrated_image(c, images.simulated), signal),
          lopsided(images.real),
          std::round(1e4 * lopsided(calibrated_image(c, images.simulated))) / 1e4 +
              0.0,  // rounding apart
          c.residual_correlation,
          c.explained,
          static_cast<double>(!c.warnings.empty())};
}

io::Plot plot(const Table& t) {
  io::PlotPanel error =
      panel(t, "", {"share of the signal from the side", false, {}}, {"relative", false, {}},
            {{"error", "rms error, gain and offset fitted"},
             {"lopsided", "wall facing it brighter by"},
             {"model_lopsided", "the same in the model", true},
             {"residual_correlation", "correlation of residuals"}});
  error.references = {{io::PlotDirection::horizontal, 0.3, "warned of above"}};
  io::Plot out;
  out.title = "A line seen by a detector partly at one side";
  out.panels = {error};
  return out;
}

}  // namespace

Sweep one_sided_detector() {
  return {"one_sided_detector",
          "a detector at one side against a model that knows no sides",
          {"share", "error", "lopsided", "model_lopsided", "residual_correlation", "explained",
           "warned"},
          {0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1},
          at,
          0.2,
          0.08,
          plot};
}

}  // namespace surf::limits
