// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "surf/core/units.h"
#include "surf/io/model/model_file.h"
#include "terminal.h"

namespace surf::cli {
namespace {

using Row = std::vector<std::string>;

std::string percent(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2f} %", 100 * part / whole) : "-";
}

void add_numbers(Row& row, const std::vector<ModelResidual>& residuals) {
  for (const ModelResidual& r : residuals) {
    row.push_back(fmt::format("{:.4g}", r.mean_signal));
    row.push_back(percent(r.rms, r.mean_signal));
    row.push_back(percent(r.mean_relative, 1));
  }
}

std::string line_of(const Row& row, const std::vector<std::size_t>& widths) {
  std::string line = fmt::format("{:<{}}", row[0], widths[0]);
  for (std::size_t i = 1; i < row.size(); ++i) line += fmt::format("  {:>{}}", row[i], widths[i]);
  return line;
}

std::string counted(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string neighbourhoods(const std::vector<FacetScale>& scales) {
  if (scales.empty()) return "";
  const auto [low, high] = std::ranges::minmax(scales, {}, &FacetScale::size);
  return fmt::format(", {} of {} to {} samples", counted(scales.size(), "neighbourhood"), low.size,
                     high.size);
}

std::string table_size(double ring_nm, int rings, double step_nm, int heights) {
  return fmt::format(", {} rings of {} x {} heights of {}", rings, format_length(ring_nm), heights,
                     format_length(step_nm));
}

// One overload per kind of model: what is worth telling besides its name.
std::string details(const FilterBankParameters& p) {
  return neighbourhoods(p.scales) + (p.multi_resolution ? ", multi-resolution" : "");
}

std::string details(const FacetNetworkParameters& p) {
  std::string text = neighbourhoods(p.scales);
  if (p.sky_edges_nm.size() > 1)
    text += fmt::format(", sky in {} to {}", counted(p.sky_edges_nm.size() - 1, "band"),
                        format_length(p.sky_edges_nm.back()));
  std::vector<int> hidden;
  std::size_t numbers = 0;
  for (const DenseLayer& layer : p.layers) {
    hidden.push_back(layer.outputs);
    numbers += layer.weights.size() + layer.biases.size();
  }
  hidden.pop_back();  // the channels
  if (!hidden.empty()) text += fmt::format(", {} hidden units", fmt::join(hidden, " and "));
  return text + ", " + counted(numbers, "number");
}

std::string details(const SlopeModelParameters& p) {
  return p.form == SlopeForm::table
             ? fmt::format(", a table in steps of {:g} degrees", p.table_step_deg)
             : "";
}

std::string details(const StoppingPointParameters& p) {
  return table_size(p.ring_nm, p.rings, p.height_step_nm, p.heights);
}

std::string details(const DiffusionMatrixParameters& p) {
  return table_size(p.ring_nm, p.rings, p.height_step_nm, p.heights);
}

}  // namespace

std::string format_scope(const ModelScope& scope) {
  std::vector<std::string> words;
  words.push_back(scope.material.empty() ? "any material" : scope.material);
  words.push_back(scope.energy_ev > 0 ? format_energy(scope.energy_ev) : "any energy");
  words.push_back(scope.pixel_nm > 0 ? "pixels of " + format_length(scope.pixel_nm)
                                     : "any pixel size");
  words.push_back(scope.spot_nm > 0 ? "spot " + format_length(scope.spot_nm)
                                    : "a point for a spot");
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string format_model(const TrainedModel& model) {
  return fmt::format(
      "{}{}; gives {}", io::kind_of(model),
      std::visit([](const auto& parameters) { return details(parameters); }, model.parameters),
      fmt::join(make_model(model)->channels(), " and "));
}

std::size_t learnt_from(const TrainingRecord& record) {
  return static_cast<std::size_t>(std::ranges::count_if(
      record.scenes, [](const TrainingScene& scene) { return !scene.held_out; }));
}

std::vector<std::string> residual_table(const TrainingRecord& record) {
  // A model that has learnt from no images may still have been judged on some.
  const auto& columns = record.residuals.empty() ? record.held_out_residuals : record.residuals;
  if (columns.empty()) return {};
  std::vector<Row> rows(1, Row{"surface"});
  for (const ModelResidual& r : columns)
    for (const std::string& column : {r.channel, std::string("rms off"), std::string("mean off")})
      rows[0].push_back(column);
  for (const TrainingScene& scene : record.scenes) {
    if (scene.residuals.size() != columns.size()) continue;
    rows.push_back({scene.name + (scene.held_out ? " (held out)" : "")});
    add_numbers(rows.back(), scene.residuals);
  }
  for (const auto& [name, residuals] : {std::pair{"all learnt from", &record.residuals},
                                        std::pair{"all held out", &record.held_out_residuals}}) {
    if (residuals->size() != columns.size()) continue;
    rows.push_back({name});
    add_numbers(rows.back(), *residuals);
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::vector<std::string> lines;
  for (const Row& row : rows) lines.push_back(line_of(row, widths));
  return lines;
}

std::string format_range(const SurfaceRange& range) {
  return fmt::format(
      "slopes to {:.0f} deg (99 % of it: {:.0f}), curvatures to {:.2g} per nm (99 %: {:.2g})",
      range.slope_deg_max, range.slope_deg_p99, range.curvature_max_per_nm,
      range.curvature_p99_per_nm);
}

}  // namespace surf::cli
