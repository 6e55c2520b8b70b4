// SPDX-License-Identifier: GPL-3.0-or-later
#include "number_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "files/text_scanner.h"
#include "scan.h"
#include "surf/core/error.h"

namespace surf::io {
namespace {

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& reason,
                       const std::string& remedy) {
  throw FileError(line > 0 ? fmt::format("{}, line {}", file, line) : file, reason, remedy);
}

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with('%'); }

/// What separates the numbers of these lines.
std::string_view separators_of(const std::vector<std::string_view>& lines) {
  constexpr std::string_view with_commas = " \t\r;,", without = " \t\r;";
  bool other_separator = false;
  for (const std::string_view line : lines) {
    if (line.find('.') != std::string_view::npos) return with_commas;
    if (line.find_first_of(without) != std::string_view::npos) other_separator = true;
    for (std::size_t i = line.find(','); i != std::string_view::npos; i = line.find(',', i + 1)) {
      if (i + 1 == line.size() || without.find(line[i + 1]) != std::string_view::npos)
        return with_commas;
    }
  }
  return other_separator ? without : with_commas;
}

/// Appends a line's numbers; how many, or nothing where one of its words is none.
std::optional<std::size_t> append_numbers(std::string_view line, std::string_view separators,
                                          std::vector<double>& values) {
  const std::size_t before = values.size();
  for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    const auto value = scan_number(line.substr(at, end - at));
    if (!value) {
      values.resize(before);
      return std::nullopt;
    }
    values.push_back(*value);
    at = line.find_first_not_of(separators, end);
  }
  return values.size() - before;
}

/// Whether a line's first word is a number, so that it can be a row.
bool begins_with_number(std::string_view line) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t;"));
  std::string_view rest;
  return scan_number(word).has_value() || leading_number(word, rest).has_value();
}

}  // namespace

NumberTable parse_number_table(const std::string& file, std::string_view content) {
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  NumberTable table;
  std::vector<std::string_view> lines;
  std::vector<std::size_t> numbers;
  std::size_t number = 0;
  for_each_text_line(content, [&](std::string_view raw) {
    ++number;
    const std::string_view line = trimmed(raw);
    if (line.empty()) return;
    if (is_comment(line) || (lines.empty() && !begins_with_number(line))) {
      table.header.push_back(trimmed(line.substr(is_comment(line) ? 1 : 0)));
      return;
    }
    lines.push_back(line);
    numbers.push_back(number);
  });
  if (lines.empty())
    fail(file, 0, "there are no numbers in it", "Give rows of heights, or lines of x, y and z");
  const std::string_view separators = separators_of(lines);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto count = append_numbers(lines[i], separators, table.values);
    if (!count) {
      fail(file, numbers[i], fmt::format("'{}' is not a row of numbers", shown(lines[i])),
           "Put # before text, and separate numbers by blanks, tabs, semicolons or commas");
    }
    if (table.columns == 0) table.columns = *count;
    if (*count != table.columns) {
      fail(file, numbers[i],
           fmt::format("there are {} numbers, and {} in the first row", *count, table.columns),
           "Give all rows the same length");
    }
  }
  table.rows = lines.size();
  return table;
}

}  // namespace surf::io
