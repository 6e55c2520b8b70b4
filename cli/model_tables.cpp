// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "surf/core/units.h"
#include "surf/io/model_file.h"
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

std::string details(const TrainedModel& model) {
  if (const auto* bank = std::get_if<FilterBankParameters>(&model.parameters); bank && !bank->scales.empty()) {
    const auto [low, high] = std::minmax_element(bank->scales.begin(), bank->scales.end(),
                                                 [](const auto& a, const auto& b) { return a.size < b.size; });
    return fmt::format(", {} neighbourhood{} of {} to {} samples{}", bank->scales.size(), bank->scales.size() == 1 ? "" : "s",
                       low->size, high->size, bank->multi_resolution ? ", multi-resolution" : "");
  }
  return "";
}

}  // namespace

std::string format_scope(const ModelScope& scope) {
  std::vector<std::string> words;
  words.push_back(scope.material.empty() ? "any material" : scope.material);
  words.push_back(scope.energy_ev > 0 ? format_energy(scope.energy_ev) : "any energy");
  words.push_back(scope.pixel_nm > 0 ? "pixels of " + format_length(scope.pixel_nm) : "any pixel size");
  words.push_back(scope.spot_nm > 0 ? "spot " + format_length(scope.spot_nm) : "a point for a spot");
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string format_model(const TrainedModel& model) {
  return fmt::format("{}{}; gives {}", io::kind_of(model), details(model), fmt::join(make_model(model)->channels(), " and "));
}

std::vector<std::string> residual_table(const TrainingRecord& record) {
  std::vector<Row> rows(1, Row{"surface"});
  for (const ModelResidual& r : record.residuals)
    for (const std::string& column : {r.channel, std::string("rms off"), std::string("mean off")}) rows[0].push_back(column);
  for (const TrainingScene& scene : record.scenes) {
    if (scene.residuals.size() != record.residuals.size()) continue;
    rows.push_back({scene.name + (scene.held_out ? " (held out)" : "")});
    add_numbers(rows.back(), scene.residuals);
  }
  rows.push_back({"all learnt from"});
  add_numbers(rows.back(), record.residuals);
  if (record.held_out_residuals.size() == record.residuals.size() && !record.residuals.empty()) {
    rows.push_back({"all held out"});
    add_numbers(rows.back(), record.held_out_residuals);
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::vector<std::string> lines;
  for (const Row& row : rows) lines.push_back(line_of(row, widths));
  return lines;
}

std::string format_range(const SurfaceRange& range) {
  return fmt::format("slopes to {:.0f} deg (99 % of it: {:.0f}), curvatures to {:.2g} per nm (99 %: {:.2g})",
                     range.slope_deg_max, range.slope_deg_p99, range.curvature_max_per_nm, range.curvature_p99_per_nm);
}

}  // namespace surf::cli
