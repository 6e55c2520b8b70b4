// SPDX-License-Identifier: GPL-3.0-or-later
// SE and BSE more and more alike: what the gains are off by for noise and for a model that is off,
// and what is said.
#include <cmath>
#include <numbers>

#include "libsurf/reconstruction/small_scene.h"
#include "surf/sem/calibration.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double se_gain = 120, bse_gain = 310, noise = 3;  // grey levels

double normal(RandomStream& random) {
  return std::sqrt(-2 * std::log(random.uniform())) *
         std::cos(2 * std::numbers::pi * random.uniform());
}

/// Less its mean, of standard deviation 1.
std::vector<double> standard(std::vector<double> v) {
  double mean = 0, squares = 0;
  for (const double x : v) mean += x / static_cast<double>(v.size());
  for (const double x : v) squares += (x - mean) * (x - mean) / static_cast<double>(v.size());
  for (double& x : v) x = (x - mean) / std::sqrt(squares);
  return v;
}

std::vector<double> at(double unlike) {
  constexpr int draws = 50;
  const test::SmallScene scene;
  const int width = scene.truth.z_nm.width(), height = scene.truth.z_nm.height();
  const std::size_t n = scene.truth.z_nm.size();
  // What both see is the slope; what one of them sees beside it has nothing to do with that.
  const std::vector<double> common = standard(scene.sem.model->predict(scene.truth)[0].data());
  std::vector<double> own = standard(scene.truth.z_nm.data());
  double both = 0;
  for (std::size_t i = 0; i < n; ++i) both += common[i] * own[i] / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) own[i] -= both * common[i];
  own = standard(own);

  CalibrationImages images;
  images.channels = {"SE", "BSE"};
  images.simulated.assign(2, Grid<double>(width, height));
  const double r = 1 - unlike, rest = std::sqrt(1 - r * r);
  for (std::size_t i = 0; i < n; ++i) {
    images.simulated[0].data()[i] = 0.9 + 0.2 * common[i];
    images.simulated[1].data()[i] = 0.25 + 0.05 * (r * common[i] + rest * own[i]);
  }
  images.real = Grid<double>(width, height);
  double squares[3] = {}, stderr_sum = 0, doubtful = 0, warned = 0, condition = 0;
  for (int draw = 0; draw < draws; ++draw) {
    RandomStream random(static_cast<std::uint64_t>(draw) + 1, 1, 0);
    Grid<double> added(width, height);
    for (double& v : added.data()) v = noise * normal(random);
    const double phase = 6.28 * random.uniform();
    // SE that the model has wrong by 2 % here and there; with free gains and with one gain of a
    // known ratio.
    for (const bool off : {false, true}) {
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double wrong =
              off ? 0.02 * std::sin(0.2 * x + phase) * std::sin(0.23 * y + 2 * phase) : 0;
          images.real(x, y) = se_gain * images.simulated[0](x, y) * (1 + wrong) +
                              bse_gain * images.simulated[1](x, y) - 14 + added(x, y);
        }
      const Calibration free = calibrate(images);
      const double error = free.gains[1] / bse_gain - 1;
      squares[off ? 1 : 0] += error * error / draws;
      if (off) {
        CalibrationOptions told;
        told.ratios = {1, bse_gain / se_gain};
        const Calibration c = calibrate(images, told);
        const double e = c.gains[1] / bse_gain - 1;
        squares[2] += e * e / draws;
        doubtful += free.outcome != CalibrationOutcome::trusted;
        warned += !free.warnings.empty();
      } else {
        condition = free.condition_number;
        stderr_sum += free.gain_stderr(1) / bse_gain / draws;
      }
    }
  }
  return {std::isfinite(condition) ? condition : NAN,
          std::sqrt(squares[0]),
          std::isfinite(stderr_sum) ? stderr_sum : NAN,
          std::sqrt(squares[1]),
          std::sqrt(squares[2]),
          doubtful / draws,
          warned / draws};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  const io::PlotAxis x{"1 - correlation of SE and BSE", true, {}};
  out.title = "Calibration with SE and BSE more and more alike";
  io::PlotPanel errors = panel(t, "grey levels have noise of 3", x,
                               {"relative error of the BSE's gain (rms of 50)", true, {}},
                               {{"error_noise", "noise alone"},
                                {"standard_error", "standard error that is given", true},
                                {"error_model", "SE of the model off by 2 % in places"},
                                {"error_ratio", "the same, ratio of the gains told"}});
  io::PlotPanel said =
      panel(t, "what is said", x,
            {"share of 50 fits, model off", false, io::PlotAxis::Range{-0.04, 1.04}},
            {{"doubtful", "doubtful"}, {"warned", "any warning", true}});
  for (io::PlotPanel* p : {&errors, &said})
    p->references.push_back({io::PlotDirection::vertical, 1 - 0.99778, "condition number 30"});
  out.panels = {errors, said};
  return out;
}

}  // namespace

Sweep calibration_alike() {
  return {"calibration_alike",
          "gains of SE and BSE that are more and more alike",
          {"unlike", "condition", "error_noise", "standard_error", "error_model", "error_ratio",
           "doubtful", "warned"},
          {1, 0.3, 0.1, 0.03, 0.01, 0.005, 0.003, 0.002, 0.001, 3e-4, 1e-4, 1e-5},
          at,
          0.002,
          1e-6,
          plot};
}

}  // namespace surf::limits
