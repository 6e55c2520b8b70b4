// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/io/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "check_plot.h"
#include "files/base64.h"
#include "files/lower_extension.h"
#include "files/run_program.h"
#include "plot_script.h"
#include "surf/core/error.h"
#include "surf/io/files.h"

namespace surf::io {
namespace {

using nlohmann::json;

constexpr int no_matplotlib = 3;  ///< what plot.py returns without it

void check_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png" || extension == ".svg") return;
  throw UsageError(path.string(),
                   fmt::format("plots are not written as '{}'", path.extension().string()),
                   "Use .svg or .png");
}

const char* name_of(PlotStyle style) {
  switch (style) {
    case PlotStyle::line:
      return "line";
    case PlotStyle::points:
      return "points";
    case PlotStyle::line_points:
      return "line_points";
    case PlotStyle::steps:
      return "steps";
    case PlotStyle::bars:
      return "bars";
    case PlotStyle::band:
      return "band";
  }
  return "line";
}

json json_of(const std::optional<PlotAxis::Range>& range) {
  return range ? json{range->from, range->to} : json();
}

json json_of(const PlotAxis& axis) {
  return {{"label", axis.label}, {"log", axis.log}, {"range", json_of(axis.range)}};
}

const char* name_of(PlotColors colors) {
  switch (colors) {
    case PlotColors::grey:
      return "grey";
    case PlotColors::heights:
      return "heights";
    case PlotColors::relief:
      return "relief";
    case PlotColors::difference:
      return "difference";
  }
  return "grey";
}

/// Values as floats in base64, less their middle, which keeps digits of heights far from 0.
json json_of(const std::optional<PlotImage>& image) {
  if (!image) return {};
  const auto& data = image->values.data();
  const auto finite =
      std::find_if(data.begin(), data.end(), [](double v) { return std::isfinite(v); });
  const double middle = finite == data.end() ? 0 : *finite;
  std::string bytes;
  bytes.reserve(4 * data.size());
  for (const double value : data) {
    // Lowest byte first, on any machine.
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value - middle));
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 0xff);
  }
  return {{"width", image->values.width()},
          {"height", image->values.height()},
          {"values", encode_base64(bytes)},
          {"middle", middle},
          {"pitch", {image->pitch_x, image->pitch_y}},
          {"origin", {image->origin_x, image->origin_y}},
          {"colors", name_of(image->colors)},
          {"range", json_of(image->range)},
          {"label", image->label},
          {"lit_per_unit", image->lit_per_unit}};
}

json json_of(const PlotSeries& series) {
  return {{"name", series.name},
          {"x", series.x},
          {"y", series.y},
          {"y_error", series.y_error},
          {"style", name_of(series.style)},
          {"dashed", series.dashed},
          {"color", series.color ? json(*series.color) : json()}};
}

json json_of(const PlotPanel& panel) {
  json series = json::array(), notes = json::array(), references = json::array(),
       bands = json::array();
  for (const PlotSeries& one : panel.series) series.push_back(json_of(one));
  for (const PlotNote& note : panel.notes) {
    notes.push_back({{"text", note.text}, {"x", note.x}, {"y", note.y}});
  }
  for (const PlotReference& line : panel.references) {
    references.push_back({{"vertical", line.direction == PlotDirection::vertical},
                          {"at", line.at},
                          {"name", line.name}});
  }
  for (const PlotBand& band : panel.bands) {
    bands.push_back({{"vertical", band.direction == PlotDirection::vertical},
                     {"from", band.from},
                     {"to", band.to},
                     {"name", band.name}});
  }
  return {{"title", panel.title}, {"x", json_of(panel.x)},  {"y", json_of(panel.y)},
          {"series", series},     {"notes", notes},         {"references", references},
          {"bands", bands},       {"legend", panel.legend}, {"image", json_of(panel.image)}};
}

json json_of(const Plot& plot) {
  const int count = static_cast<int>(plot.panels.size());
  // Four panels look better as two by two.
  const int columns = std::min(count, plot.columns > 0 ? plot.columns : count == 4 ? 2 : 3);
  int cell = 0;  // the next free one, by rows
  json panels = json::array();
  for (const PlotPanel& panel : plot.panels) {
    const int span = std::min(panel.columns, columns);
    if (cell % columns + span > columns) cell += columns - cell % columns;
    panels.push_back(json_of(panel));
    panels.back()["cells"] = {cell + 1, cell + span};
    cell += span;
  }
  const int rows = (cell + columns - 1) / columns;
  // The height of a row as a share of the width.
  const double height = columns == 1 ? 0.625 : columns == 2 ? 0.43 : 0.33;
  const double automatic = std::clamp(plot.width_px * height * rows, 200.0, 10000.0);
  std::string description;
  for (const auto& [key, value] : plot.metadata)
    description += fmt::format("{} = {}\n", key, value);
  return {{"title", plot.title},
          {"description", description},
          {"panels", panels},
          {"rows", rows},
          {"columns", columns},
          {"width_px", plot.width_px},
          {"height_px", plot.height_px > 0 ? plot.height_px : static_cast<int>(automatic)}};
}

std::vector<std::string> interpreters() {
  const char* const chosen = std::getenv("SEMSURF_PYTHON");
  if (chosen && *chosen) return {chosen};
  return {"/usr/bin/python3", "python3"};
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// Lets the first Python that has Matplotlib draw.
void draw(const std::filesystem::path& target, const std::string& kind, const std::string& input,
          const std::string& file) {
  std::string tried;
  for (const std::string& python : interpreters()) {
    const ProgramEnd end =
        run_program({python, "-I", "-c", plot_script, target.string(), kind}, input);
    if (end.started && end.code == 0 && !std::filesystem::is_empty(target)) return;
    if (end.started && end.code != no_matplotlib) {
      const std::string line = last_line(end.errors);
      if (line.starts_with("KeyboardInterrupt")) throw Interrupted();  // Ctrl-C reached both
      throw FileError(file,
                      fmt::format("drawing it failed ({}: {})", python,
                                  line.empty() ? fmt::format("exit code {}", end.code) : line),
                      "Check the free space and memory, or set SEMSURF_PYTHON to a Python 3 with a "
                      "working Matplotlib");
    }
    tried += fmt::format("{}{} {}", tried.empty() ? "" : ", ", python,
                         end.started ? "has no Matplotlib" : "cannot be run");
  }
  throw Unsupported(file, fmt::format("plots are drawn by Python 3 with Matplotlib ({})", tried),
                    "Install it (Debian: apt-get install python3-matplotlib), or name a Python "
                    "that has it by SEMSURF_PYTHON");
}

}  // namespace

void write_plot(const std::filesystem::path& path, const Plot& plot) {
  check_name(path);
  const std::string file = path.string();
  check_plot(plot, file);
  // Bytes that are no UTF-8 become a mark.
  const std::string input = json_of(plot).dump(-1, ' ', true, json::error_handler_t::replace);
  const std::string kind = lower_extension(path).substr(1);
  write_atomically(
      path, [&](const std::filesystem::path& temporary) { draw(temporary, kind, input, file); });
}

void check_plot_target(const std::filesystem::path& path) {
  check_name(path);
  check_writable(path);
}

}  // namespace surf::io
