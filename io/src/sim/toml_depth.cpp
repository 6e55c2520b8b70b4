// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/toml_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "surf/core/error.h"

namespace surf::io {
namespace {

/// Where the text that begins at `at` with a quotation mark ends; where the line or the file ends
/// if its own end is missing, which the parser then reports.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
  const char mark = text[at];
  const std::string three(3, mark);
  const bool many_lines = text.substr(at, 3) == three;
  const bool has_escapes = mark == '"';
  for (at += many_lines ? 3 : 1; at < text.size(); ++at) {
    if (has_escapes && text[at] == '\\') {
      ++at;
    } else if (!many_lines && (text[at] == mark || text[at] == '\n')) {
      return at + (text[at] == mark ? 1 : 0);
    } else if (many_lines && text.substr(at, 3) == three) {
      at += 3;
      // Up to two marks before the closing three belong to the text.
      for (int i = 0; i < 2 && at < text.size() && text[at] == mark; ++i) ++at;
      return at;
    }
  }
  return text.size();
}

[[noreturn]] void refuse(std::string_view text, std::size_t begin, const std::string& file) {
  const std::string_view before = text.substr(0, begin);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t column = begin - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  throw FileError(fmt::format("{}, line {}, column {}", file, line, column),
                  fmt::format("a key has more than {} parts", most_key_parts),
                  "Correct the TOML text there: a key such as beam.energy has two");
}

}  // namespace

void check_key_depth(std::string_view text, const std::string& file) {
  constexpr std::string_view between_keys = "\n=,[]{}";
  constexpr std::string_view blanks = " \t\r";
  std::size_t begin = 0;
  int dots = 0;  // since `begin`; a value has one at most
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '"' || c == '\'') {
      at = end_of_quoted(text, at);
    } else if (between_keys.find(c) != std::string_view::npos) {
      begin = ++at;
      dots = 0;
    } else {
      if (dots == 0 && at == begin && blanks.find(c) != std::string_view::npos) ++begin;
      if (c == '.' && ++dots >= most_key_parts) refuse(text, begin, file);
      ++at;
    }
  }
}

}  // namespace surf::io
