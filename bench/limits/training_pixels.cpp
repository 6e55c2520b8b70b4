// SPDX-License-Identifier: GPL-3.0-or-later
// How many pixels it takes to learn a filter bank or a network, judged on a surface of the same
// kind.
#include <cmath>
#include <utility>
#include <vector>

#include "small_models.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

/// All but `pixels` in all are left out, by chance.
std::vector<TrainingImage> thinned(double pixels) {
  std::vector<TrainingImage> images = gentle_training();
  std::vector<unsigned char*> all;
  for (TrainingImage& image : images) {
    image.used = Mask(image.field.z_nm.width(), image.field.z_nm.height(), 0);
    for (unsigned char& used : image.used.data()) all.push_back(&used);
  }
  RandomStream random(5, 0, 0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(pixels) && k < all.size(); ++k) {
    const auto other =
        k + static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size() - k));
    std::swap(all[k], all[other]);
    *all[k] = 1;
  }
  return images;
}

std::vector<double> at(double pixels) {
  static const TrainingImage truth = monte_carlo(rough(3, 15, 11));
  const std::vector<TrainingImage> images = thinned(pixels);
  std::vector<double> row, warned;
  const auto judge = [&](const auto& learn) {
    try {
      const TrainedModel model = learn();
      row.push_back(se_error(model, truth));
      warned.push_back(!model.record.warnings.empty());
    } catch (const InvalidInput&) {
      row.push_back(NAN);
      warned.push_back(2);
    }
  };
  judge([&] { return learn_bank(images, 0.1); });
  judge([&] { return learn_bank(images, 0); });
  judge([&] { return learn_network(images); });
  row.insert(row.end(), warned.begin(), warned.end());
  return row;
}

io::Plot plot(const Table& t) {
  io::PlotPanel error =
      panel(t, "", {"pixels learnt from", true, {}}, {"rms error of SE, relative", true, {}},
            {{"bank_error", "filter bank, cut-off 0.1"},
             {"whole_bank_error", "filter bank, no cut-off"},
             {"network_error", "facet network"}});
  double warned = 0;
  for (const auto& row : t.rows)
    if (row[4] > 0) warned = row[0];
  error.bands = {{io::PlotDirection::vertical, t.rows.front()[0], warned, "bank: warned"}};
  io::Plot out;
  out.title = "Models learnt from few pixels, on another surface";
  out.panels = {error};
  return out;
}

}  // namespace

Sweep training_pixels() {
  return {"training_pixels",
          "how many pixels it takes to learn a model",
          {"pixels", "bank_error", "whole_bank_error", "network_error", "bank_says",
           "whole_bank_says", "network_says"},
          {10, 20, 40, 80, 160, 320, 640, 1280, 2560, 4096},
          at,
          80,
          0.02,
          plot};
}

}  // namespace surf::limits
