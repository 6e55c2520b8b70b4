// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces whose features are smaller or larger than those that a model has learnt from, just as
// steep.
#include <vector>

#include "small_models.h"
#include "surf/sem/surface_range.h"
#include "surf/workflow/predict_job.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double correlation_nm) {
  const TrainingImage truth = monte_carlo(rough(correlation_nm / 5, correlation_nm, 11));
  const SurfaceRange range = surface_range(truth.field), learnt = gentle_bank().record.range;
  return {se_error(gentle_bank(), truth), se_error(gentle_network(), truth),
          range.curvature_p99_per_nm / learnt.curvature_p99_per_nm,
          range.slope_deg_max / learnt.slope_deg_max,
          static_cast<double>(!workflow::prediction_warnings(gentle_bank(), truth.field).empty())};
}

io::Plot plot(const Table& t) {
  io::PlotPanel error =
      panel(t, "", {"correlation length (nm)", true, {}}, {"rms error of SE, relative", true, {}},
            {{"bank_error", "filter bank"}, {"network_error", "facet network"}});
  error.references = {{io::PlotDirection::vertical, 15, "learnt from"}};
  io::Plot out;
  out.title = "Features of other sizes, as steep as those learnt from";
  out.panels = {error};
  return out;
}

}  // namespace

Sweep off_training_sizes() {
  return {
      "off_training_sizes",
      "models on features of other sizes than those learnt from",
      {"correlation_nm", "bank_error", "network_error", "curvature_ratio", "slope_ratio", "warned"},
      {4, 6, 8, 10, 15, 20, 30, 45},
      at,
      8,
      0.15,
      plot};
}

}  // namespace surf::limits
