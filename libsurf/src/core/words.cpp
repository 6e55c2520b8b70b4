// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/words.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <numeric>
#include <utility>

namespace surf {

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find_first_of(separators);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string quoted_command(const std::vector<std::string>& words) {
  const auto is_plain = [](unsigned char c) {
    return c != 0 && (std::isalnum(c) || std::strchr("-_=+./,:%@", c));
  };
  std::string line;
  for (const std::string& word : words) {
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += (line.empty() ? "" : " ") +
            (!word.empty() && std::ranges::all_of(word, is_plain) ? word : quoted + "'");
  }
  return line;
}

}  // namespace surf
