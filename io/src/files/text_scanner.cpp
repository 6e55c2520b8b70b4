// SPDX-License-Identifier: GPL-3.0-or-later
#include "text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "surf/core/error.h"

namespace surf::io {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::string shown(std::string_view word) {
  std::string text;
  for (const char c : word.substr(0, 30)) text += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > 30 ? text + "..." : text;
}

TextScanner::TextScanner(std::string file, std::string_view text, Syntax syntax)
    : file_(std::move(file)), text_(text), syntax_(syntax) {
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;
}

void TextScanner::skip_blanks() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (is_blank(c)) {
      ++position_;
    } else if (c == '\\' && syntax_.continuation) {
      std::size_t next = position_ + 1;
      while (next < text_.size() && is_blank(text_[next])) ++next;
      if (next < text_.size() && text_[next] != '\n') return;
      position_ = std::min(next + 1, text_.size());
    } else if (c == syntax_.comment && c != '\0') {
      position_ = std::min(text_.find('\n', position_), text_.size());
    } else {
      return;
    }
  }
}

bool TextScanner::at_line_end() {
  skip_blanks();
  return position_ == text_.size() || text_[position_] == '\n';
}

bool TextScanner::next_filled_line() {
  while (at_line_end()) {
    if (position_ == text_.size()) return false;
    ++position_;
  }
  return true;
}

bool TextScanner::at_end() { return !next_filled_line(); }

void TextScanner::skip_line() { position_ = std::min(text_.find('\n', position_), text_.size()); }

std::string_view TextScanner::word() {
  skip_blanks();
  const std::size_t begin = position_;
  while (position_ < text_.size() && text_[position_] != '\n' && !is_blank(text_[position_]) &&
         (text_[position_] != syntax_.comment || syntax_.comment == '\0')) {
    ++position_;
  }
  return text_.substr(begin, position_ - begin);
}

std::string_view TextScanner::word_on_any_line() {
  return next_filled_line() ? word() : std::string_view{};
}

double TextScanner::number(std::string_view what) {
  const std::string_view text = word();
  const char* const begin = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (text.empty() || stop != end || error == std::errc::invalid_argument) {
    fail_expected(what, text);
  }
  // Both 1e400 and 1e-400 are out of range, but the latter is as good as 0.
  if (error == std::errc::result_out_of_range) {
    value = std::strtod(std::string(text).c_str(), nullptr);
  }
  if (!std::isfinite(value)) {
    fail(fmt::format("{} is '{}'", what, shown(text)),
         "Remove or repair it: only finite numbers can be used");
  }
  return value;
}

std::int64_t TextScanner::integer(std::string_view what) {
  const std::string_view text = word();
  const char* const end = text.data() + text.size();
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || stop != end || error != std::errc{}) fail_expected(what, text);
  return value;
}

void TextScanner::expect_line_end(std::string_view what) {
  if (!at_line_end()) {
    fail(fmt::format("'{}' follows after {}", shown(word()), what),
         "Remove it, or check that the header describes the lines");
  }
}

void TextScanner::fail_expected(std::string_view what, std::string_view found) const {
  if (!found.empty()) fail(fmt::format("expected {}, found '{}'", what, shown(found)));
  const bool ended = text_.find_first_not_of(" \t\r\n\v\f", position_) == std::string_view::npos;
  if (ended) fail(fmt::format("the file ends where {} is expected", what));
  fail(fmt::format("the line ends where {} is expected", what));
}

void TextScanner::fail(const std::string& reason, const std::string& remedy) const {
  const auto line =
      1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(position_), '\n');
  throw FileError(fmt::format("{}, line {}", file_, line), reason,
                  remedy.empty() ? "Repair the file or export it again" : remedy);
}

}  // namespace surf::io
