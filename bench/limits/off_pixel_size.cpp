// SPDX-License-Identifier: GPL-3.0-or-later
// A model for pixels of 3 nm, and heights sampled otherwise: refused; resampled; or said to be 3 nm
// apart.
#include <algorithm>
#include <cmath>
#include <vector>

#include "small_models.h"
#include "surf/afm/resample.h"
#include "surf/core/error.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

/// The lower left part of an image.
template <class T>
Grid<T> cropped(const Grid<T>& image, int size) {
  Grid<T> out(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) out(x, y) = image(x, y);
  return out;
}

/// Of heights that were resampled to the model's pixels, beside an image of the surface itself.
double resampled_error(const HeightField& field, const HeightField& fine) {
  static const TrainingImage truth = monte_carlo(resampled(fine, 3));
  const Grid<double> predicted = make_model(gentle_bank())->predict(resampled(field, 3)).front();
  const int size = std::min(predicted.width(), truth.field.z_nm.width());
  TrainingImage part;
  part.images = {cropped(truth.images.front(), size)};
  part.standard_errors = {cropped(truth.standard_errors.front(), size)};
  return error_beyond_noise(cropped(predicted, size), part);
}

std::vector<double> at(double ratio) {
  const HeightField fine = rough(3, 15, 11, 4 * 31 + 1, 0.75);
  const HeightField field = resampled(fine, 3 * ratio);
  double refused = 0;
  try {
    check_field(gentle_bank().scope, field);
  } catch (const InvalidInput&) {
    refused = 1;
  }
  HeightField lie = field;
  lie.pitch_x_nm = lie.pitch_y_nm = 3;
  const double wrong =
      error_beyond_noise(make_model(gentle_bank())->predict(lie).front(), monte_carlo(field));
  return {refused, wrong, resampled_error(field, fine)};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "A model for 3 nm: refused but at 1";
  out.panels = {panel(
      t, "", {"distance of samples over 3 nm", true, {{0.6, 2.2}}},
      {"rms error of SE, relative", true, {}},
      {{"wrong_error", "if said to be 3 nm apart"}, {"resampled_error", "resampled to 3 nm"}})};
  return out;
}

}  // namespace

Sweep off_pixel_size() {
  return {"off_pixel_size",
          "a model for pixels of 3 nm on heights sampled otherwise",
          {"ratio", "refused", "wrong_error", "resampled_error"},
          {0.67, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 2},
          at,
          1.1,
          0.02,
          plot};
}

}  // namespace surf::limits
