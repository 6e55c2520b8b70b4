// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/sweep_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "surf/core/error.h"

namespace surf::workflow {
namespace {

constexpr std::size_t most_runs = 1'000'000, most_tried = 100;

struct Number {
  double value = 0;
  std::string unit;
};

Number number(const std::string& text, const std::string& subject) {
  Number out;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.value);
  if (error != std::errc() || !std::isfinite(out.value))
    throw UsageError(subject, fmt::format("'{}' is not a number with a unit", text),
                     "Write 0deg:60deg:5deg, say");
  out.unit.assign(end, text.data() + text.size());
  return out;
}

std::vector<std::string> range(const std::string& text, const std::string& subject) {
  const std::size_t a = text.find(':'), b = text.find(':', a + 1);
  if (b == std::string::npos || text.find(':', b + 1) != std::string::npos)
    throw UsageError(subject, fmt::format("'{}' is no range", text),
                     "Write FROM:TO:STEP, as 0deg:60deg:5deg");
  const Number from = number(text.substr(0, a), subject),
               to = number(text.substr(a + 1, b - a - 1), subject),
               step = number(text.substr(b + 1), subject);
  if (from.unit != to.unit || from.unit != step.unit)
    throw UsageError(subject, fmt::format("'{}' mixes units", text),
                     "Give all three of the range the same one");
  const double count = (to.value - from.value) / step.value;
  if (!(count >= 0) || !std::isfinite(count) || count > double(most_runs))
    throw UsageError(subject, fmt::format("'{}' does not lead from the first to the second", text),
                     "Give a step of the right sign, and at most a million of them");
  std::vector<std::string> out;
  for (int i = 0; i <= static_cast<int>(std::floor(count * (1 + 1e-12) + 1e-9)); ++i)
    out.push_back(fmt::format("{:.12g}{}", from.value + i * step.value, from.unit));
  return out;
}

}  // namespace

std::vector<std::string> parse_sweep_values(const std::string& text, const std::string& subject) {
  std::vector<std::string> all;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string value = text.substr(from, comma - from);
    if (value.empty()) throw UsageError(subject, "a value is empty", "Leave out the comma");
    if (value.find(':') == std::string::npos) all.push_back(value);
    else
      for (std::string& one : range(value, subject)) all.push_back(std::move(one));
    from = comma + 1;
  }
  return all;
}

SweepGrid::SweepGrid(std::vector<SweepAxis> axes, const std::string& subject)
    : axes_(std::move(axes)) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      if (axes_[a].name == axes_[b].name)
        throw UsageError(subject, fmt::format("'{}' is given twice", axes_[a].name),
                         "Put its values into one list");
    runs_ *= axes_[a].values.size();
    if (runs_ > most_runs)
      throw UsageError(subject, "these are more than a million runs", "Give fewer values");
  }
}

std::vector<std::string> SweepGrid::values(std::size_t run) const {
  std::vector<std::string> values(axes_.size());
  for (std::size_t a = axes_.size(); a-- > 0;) {
    values[a] = axes_[a].values[run % axes_[a].values.size()];
    run /= axes_[a].values.size();
  }
  return values;
}

std::string SweepGrid::file_name(std::size_t run) const {
  const std::vector<std::string> of_run = values(run);
  std::string name;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    std::string value = of_run[i];
    for (char& c : value)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '%') c = '_';
    name += fmt::format("{}{}_{}", i ? "," : "", axes_[i].name, value);
  }
  return name;
}

std::vector<std::size_t> SweepGrid::tried() const {
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < runs_; i = runs_ <= most_tried || i + 1 == runs_ ? i + 1 : runs_ - 1)
    some.push_back(i);
  return some;
}

}  // namespace surf::workflow
