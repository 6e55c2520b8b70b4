// SPDX-License-Identifier: GPL-3.0-or-later
// The filter bank's cut-off of principal components: errors on what was learnt from, on another
// surface of the same kind and on one of another kind.
#include <cstdlib>
#include <vector>

#include "small_models.h"
#include "surf/mesh/shapes.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

/// One surface with few electrons: what a bank of 31 numbers a channel can just be learnt from.
const std::vector<TrainingImage>& training() {
  static const std::vector<TrainingImage> images{
      monte_carlo(rough(3, 15, 1, 24), {.electrons = 10, .seed = 2})};
  return images;
}

std::vector<double> at(double cut_off) {
  static const TrainingImage same = monte_carlo(rough(3, 15, 11), {.seed = 2});
  static const TrainingImage other = monte_carlo(make_mesa({93, 93, 3}, 10, 36, 15), {.seed = 2});
  const TrainedModel model = learn_bank(training(), cut_off);
  return {se_error(model, training().front()),
          se_error(model, same),
          se_error(model, other),
          std::strtod(model.record.notes.at("components").c_str(), nullptr),
          model.record.condition_number,
          static_cast<double>(!model.record.warnings.empty())};
}

io::Plot plot(const Table& t) {
  io::PlotPanel error =
      panel(t, "", {"cut-off of eigenvalues", true, {}}, {"rms error of SE, relative", false, {}},
            {{"same_kind_error", "same kind"}, {"other_kind_error", "a mesa"}});
  double warned = 0;
  for (const auto& row : t.rows)
    if (row[6] > 0) warned = row[0];
  error.references = {{io::PlotDirection::vertical, 0.1, "default"}};
  error.bands = {{io::PlotDirection::vertical, t.rows.front()[0], warned, "warned"}};
  io::Plot out;
  out.title = "A bank of 576 noisy pixels";
  out.panels = {error};
  return out;
}

}  // namespace

Sweep bank_cutoff() {
  return {"bank_cutoff",
          "the filter bank's cut-off of principal components, with few pixels",
          {"cut_off", "training_error", "same_kind_error", "other_kind_error", "components",
           "condition_number", "warned"},
          {1e-5, 1e-4, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 2, 4},
          at,
          0.0003,
          0.01,
          plot};
}

}  // namespace surf::limits
