// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/measured_yields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/io/csv_line.h"
#include "surf/io/files.h"

namespace surf::workflow {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 26;

class Table {
 public:
  Table(const std::filesystem::path& path, std::string_view names)
      : path_(path), names_(io::split_csv_line(names)) {}

  bool has(const char* name) const { return column(name) < names_.size(); }
  void read(std::string_view line, std::size_t number) {
    fields_ = io::split_csv_line(line);
    number_ = number;
  }
  // The field of a column; empty if the line ends before it.
  std::string text(const char* name) const {
    const std::size_t i = column(name);
    return i < fields_.size() ? fields_[i] : std::string();
  }
  double number(const char* name) const {
    const std::string text = this->text(name);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
        value < 0)
      throw FileError(path_.string(), fmt::format("line {}: '{}' is no {}", number_, text, name),
                      "Give a number that is not negative");
    return value;
  }

 private:
  std::size_t column(const char* name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  std::filesystem::path path_;
  std::vector<std::string> names_, fields_;
  std::size_t number_ = 0;
};

}  // namespace

std::vector<MeasuredYield> read_measured_yields(const std::filesystem::path& path) {
  const std::string content = io::read_file(path, most_bytes);
  std::string_view rest = content;
  const auto next_line = [&] {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return line;
  };
  Table table(path, next_line());
  const bool backscattered = table.has("eta");
  if (!table.has("element") || !table.has("energy_keV") || (!backscattered && !table.has("delta")))
    throw FileError(path.string(), "its first line does not name the columns",
                    "Begin with: element,energy_keV,delta (or eta)");
  std::vector<MeasuredYield> yields;
  for (std::size_t number = 2; !rest.empty(); ++number) {
    const std::string_view line = next_line();
    if (line.find_first_not_of(" \r,") == std::string_view::npos) continue;
    table.read(line, number);
    const std::string quantity = table.text("quantity");
    if (!quantity.empty() && quantity != "SE" && quantity != "BSE") continue;
    MeasuredYield y;
    y.material = table.text("element");
    y.energy_ev = 1000 * table.number("energy_keV");
    y.yield = table.number(backscattered ? "eta" : "delta");
    y.backscattered = backscattered;
    if (y.energy_ev > 0) yields.push_back(y);
  }
  return yields;
}

}  // namespace surf::workflow
