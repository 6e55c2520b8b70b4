// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces steeper, or flatter, than those that a model has learnt from.
#include <vector>

#include "small_models.h"
#include "surf/sem/surface_range.h"
#include "surf/workflow/predict_job.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double factor) {
  const TrainingImage truth = monte_carlo(scaled(rough(3, 15, 11), factor));
  const double steepest = gentle_bank().record.range.slope_deg_max;
  return {surface_range(truth.field).slope_deg_max, se_error(gentle_bank(), truth),
          se_error(gentle_network(), truth), share_steeper(truth.field, steepest),
          static_cast<double>(!workflow::prediction_warnings(gentle_bank(), truth.field).empty())};
}

io::Plot plot(const Table& t) {
  io::PlotPanel error = panel(t, "", {"heights over those learnt from", true, {}},
                              {"rms error of SE, relative", true, {}},
                              {{"bank_error", "filter bank"}, {"network_error", "facet network"}});
  for (const auto& row : t.rows)
    if (row[5] > 0) {
      error.bands = {{io::PlotDirection::vertical, row[0], t.rows.back()[0], "warned"}};
      break;
    }
  io::Plot out;
  out.title = "Rough surfaces steeper than those learnt from";
  out.panels = {error};
  return out;
}

}  // namespace

Sweep off_training_slopes() {
  return {"off_training_slopes",
          "models on surfaces steeper than those learnt from",
          {"factor", "slope_deg_max", "bank_error", "network_error", "steeper", "warned"},
          {0.25, 0.5, 1, 1.4, 2, 2.8, 4, 6},
          at,
          2,
          0.15,
          plot};
}

}  // namespace surf::limits
