// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "info.h"
#include "model_tables.h"
#include "surf/io/model/model_file.h"
#include "terminal.h"

namespace surf::cli {
namespace {

std::string format_condition(double number) {
  if (std::isinf(number)) return "infinite: the outputs depend on each other";
  return fmt::format("{:.3g}", number);
}

std::string format_pixels(const TrainingRecord& record) {
  const std::size_t learnt = learnt_from(record);
  std::string text =
      learnt == 0 ? "no images" : fmt::format("{} surface{}", learnt, learnt == 1 ? "" : "s");
  if (!record.residuals.empty())
    text += fmt::format(", {} pixels", record.residuals.front().pixels);
  if (learnt < record.scenes.size())
    text += fmt::format("; {} held out", record.scenes.size() - learnt);
  return text;
}

}  // namespace

void print_model(const std::filesystem::path& path) {
  const TrainedModel model = io::read_model(path);
  const TrainingRecord& record = model.record;
  print("{}: image model\n", path.string());
  print_item("kind", format_model(model));
  print_item("for", format_scope(model.scope));
  print_item("learnt on", format_pixels(record));
  if (learnt_from(record) > 0) print_item("range", format_range(record.range));
  if (record.condition_number != 0)
    print_item("condition", format_condition(record.condition_number));
  for (const std::string& warning : record.warnings) print_item("warning", warning);
  if (const std::vector<std::string> table = residual_table(record); !table.empty()) {
    print(
        "  how far it is off (mean signal per primary; in % of it rms, the images' noise "
        "subtracted,\n"
        "  and mean, noise included)\n");
    for (const std::string& line : table) print("    {}\n", line);
  }
  if (record.notes.empty()) return;
  print("  how it was made\n");
  for (const auto& [key, value] : record.notes) print("    {:<16}  {}\n", key, value);
}

}  // namespace surf::cli
