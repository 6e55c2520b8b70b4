// SPDX-License-Identifier: GPL-3.0-or-later
#include "training.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <utility>
#include <variant>

#include "convert/table.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/io/model/model_file.h"

namespace surf::pv {
namespace {

constexpr double share_of_images = 0.8;  // of the progress, where images have to be made first

/// How many numbers a model has learnt, or its table holds.
struct Numbers {
  std::size_t operator()(const SlopeModelParameters& p) const {
    std::size_t count = 0;
    for (const SlopeChannel& channel : p.channels)
      count += p.form == SlopeForm::table ? channel.yields.size() : 1;
    return count;
  }
  std::size_t operator()(const FilterBankParameters& p) const {
    return p.channels.size() * (1 + 3 * p.scales.size());
  }
  std::size_t operator()(const FacetNetworkParameters& p) const {
    std::size_t count = 0;
    for (const DenseLayer& layer : p.layers) count += layer.weights.size() + layer.biases.size();
    return count;
  }
  std::size_t operator()(const StoppingPointParameters& p) const {
    std::size_t count = 0;
    for (const auto& channel : p.channels) count += channel.density_per_nm.size();
    return count;
  }
  std::size_t operator()(const DiffusionMatrixParameters& p) const {
    std::size_t count = 0;
    for (const auto& channel : p.channels) count += channel.moments_per_nm2.size();
    return count;
  }
};

}  // namespace

workflow::TrainSummary train(const workflow::TrainJob& job, const Watch& watch,
                             std::vector<std::string>& notes) {
  double learning_from = 0;
  workflow::Reporter listener;
  listener.on_progress = [&](double done, double total, std::string_view things) {
    if (things == "pixels") {
      learning_from = share_of_images;
      watch.part(0, share_of_images).report(done, total);
    } else if (things.empty()) {
      watch.part(learning_from, 1).report(done, total);
    }
  };
  listener.on_note = [&notes](const std::string& note) { notes.push_back(note); };
  listener.cancel = watch.cancel;
  workflow::TrainSummary summary = workflow::run(job, listener);
  if (!summary.complete) throw Interrupted();
  return summary;
}

void fill_errors(vtkTable* table, const TrainingRecord& record) {
  // A model that has learnt from no images may still have been judged on some.
  const auto& columns = record.residuals.empty() ? record.held_out_residuals : record.residuals;
  std::vector<std::string> names;
  std::vector<int> held_out, widths, heights;
  std::vector<double> electrons;
  std::vector<const std::vector<ModelResidual>*> rows;
  const auto add = [&](const std::string& name, bool held,
                       const std::vector<ModelResidual>& residuals) -> bool {
    if (residuals.empty() || residuals.size() != columns.size()) return false;
    names.push_back(name);
    held_out.push_back(held);
    rows.push_back(&residuals);
    return true;
  };
  for (const TrainingScene& scene : record.scenes) {
    if (!add(scene.name, scene.held_out, scene.residuals)) continue;
    widths.push_back(scene.width), heights.push_back(scene.height);
    electrons.push_back(static_cast<double>(scene.electrons));
  }
  add("all learnt from", false, record.residuals);
  add("all held out", true, record.held_out_residuals);
  widths.resize(rows.size()), heights.resize(rows.size()), electrons.resize(rows.size());
  add_column(table, "surface", names);
  add_column(table, "held_out", std::move(held_out));
  add_column(table, "width", std::move(widths));
  add_column(table, "height", std::move(heights));
  add_column(table, "electrons", std::move(electrons));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<double> signal, rms, mean;
    for (const auto* row : rows) {
      const ModelResidual& r = (*row)[c];
      signal.push_back(r.mean_signal);
      rms.push_back(r.mean_signal > 0 ? r.rms / r.mean_signal : 0);
      mean.push_back(r.mean_relative);
    }
    add_column(table, columns[c].channel + "_mean", std::move(signal));
    add_column(table, columns[c].channel + "_rms_off", std::move(rms));
    add_column(table, columns[c].channel + "_mean_off", std::move(mean));
  }
}

void fill_model(vtkTable* table, const workflow::TrainJob& job, const workflow::TrainSummary& s,
                const std::vector<std::string>& notes) {
  std::vector<std::string> names, values;
  const auto add = [&](const std::string& name, const std::string& value) {
    names.push_back(name);
    values.push_back(value);
  };
  const TrainedModel& model = s.model;
  const TrainingRecord& record = model.record;
  add("file", job.output.string());
  add("kind", io::kind_of(model));
  add("channels", fmt::format("{}", fmt::join(make_model(model)->channels(), ", ")));
  add("numbers", std::to_string(std::visit(Numbers(), model.parameters)));
  add("material", model.scope.material);
  add("energy_ev", format_exact(model.scope.energy_ev));
  add("spot_nm", format_exact(model.scope.spot_nm));
  add("pixel_nm", format_exact(model.scope.pixel_nm));
  add("images_simulated", std::to_string(s.images_made));
  add("images_found", std::to_string(s.images_found));
  if (!s.images.empty()) add("images_folder", s.images.string());
  if (!record.residuals.empty()) {
    add("slope_deg_max", fmt::format("{:.4g}", record.range.slope_deg_max));
    add("curvature_per_nm_max", fmt::format("{:.4g}", record.range.curvature_max_per_nm));
  }
  if (record.condition_number != 0)
    add("condition_number", fmt::format("{:.4g}", record.condition_number));
  for (const auto& [key, value] : record.notes) add(key, value);
  for (const std::string& warning : record.warnings) add("warning", warning);
  for (const std::string& note : notes) add("note", note);
  add_column(table, "quantity", names);
  add_column(table, "value", values);
}

}  // namespace surf::pv
