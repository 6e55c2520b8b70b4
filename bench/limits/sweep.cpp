// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "surf/core/error.h"
#include "surf/io/csv_line.h"

namespace surf::limits {
namespace {

std::size_t number_of(const Table& table, const std::string& name) {
  const auto at = std::find(table.columns.begin(), table.columns.end(), name);
  if (at == table.columns.end())
    throw InvalidInput(name, "there is no such column", "Look at the sweep's columns");
  return static_cast<std::size_t>(at - table.columns.begin());
}

}  // namespace

std::vector<double> Table::column(const std::string& name) const {
  const std::size_t at = number_of(*this, name);
  std::vector<double> out;
  for (const auto& row : rows) out.push_back(row.at(at));
  return out;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (const std::string& name : table.columns) text += (text.empty() ? "" : ",") + name;
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format("{}{}", i ? "," : "",
                          std::isfinite(row[i]) ? fmt::format("{:.9g}", row[i]) : "");
    text += '\n';
  }
  return text;
}

Table from_csv(const std::string& text, const std::string& subject) {
  std::istringstream in(text);
  std::string line;
  Table table;
  if (std::getline(in, line)) table.columns = io::split_csv_line(line);
  while (std::getline(in, line)) {
    std::vector<double> row;
    for (const std::string& field : io::split_csv_line(line)) {
      double value = std::numeric_limits<double>::quiet_NaN();
      const auto end = field.data() + field.size();
      if (!field.empty() && std::from_chars(field.data(), end, value).ptr != end)
        throw InvalidInput(subject, fmt::format("'{}' is not a number", field),
                           "Make it again with bench_limits");
      row.push_back(value);
    }
    if (row.size() != table.columns.size())
      throw InvalidInput(
          subject, fmt::format("a line has {} fields, not {}", row.size(), table.columns.size()),
          "Make it again with bench_limits");
    table.rows.push_back(std::move(row));
  }
  return table;
}

io::PlotPanel panel(const Table& table, const std::string& title, const io::PlotAxis& x,
                    const io::PlotAxis& y, const std::vector<Curve>& curves) {
  io::PlotPanel out;
  out.title = title;
  out.x = x;
  out.y = y;
  const std::vector<double> across = table.column(table.columns.front());
  for (const Curve& curve : curves) {
    io::PlotSeries series;
    series.name = curve.name;
    series.style = io::PlotStyle::line_points;
    series.dashed = curve.dashed;
    const std::vector<double> up = table.column(curve.column);
    const bool bars = std::find(table.columns.begin(), table.columns.end(),
                                curve.column + "_error") != table.columns.end();
    const std::vector<double> errors =
        bars ? table.column(curve.column + "_error") : std::vector<double>();
    for (std::size_t i = 0; i < up.size(); ++i) {
      if (!std::isfinite(up[i]) || (y.log && !(up[i] > 0)) || (x.log && !(across[i] > 0))) continue;
      series.x.push_back(across[i]);
      series.y.push_back(up[i]);
      if (bars) series.y_error.push_back(errors[i]);
    }
    if (!series.x.empty()) out.series.push_back(std::move(series));
  }
  return out;
}

}  // namespace surf::limits
