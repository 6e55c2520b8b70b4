// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <vector>

#include "files/base64.h"
#include "mutators.h"

namespace surf::test {
namespace {

struct Range {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

struct Style {
  bool whole_lines = true;    ///< lines may be copied, exchanged and removed
  bool json_numbers = false;  ///< no nan, no infinity
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_base64(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '/' || c == '=';
}

/// The run of characters around `at` for which `is` holds.
template <class Is>
Range run_around(std::string_view text, std::size_t at, Is is) {
  Range run{at, at};
  while (run.begin > 0 && is(text[run.begin - 1])) --run.begin;
  while (run.end < text.size() && is(text[run.end])) ++run.end;
  return run;
}

/// The first number at or after `from`, then from the start; empty if there is none.
Range find_number(std::string_view text, std::size_t from) {
  for (std::size_t step = 0; step < text.size(); ++step) {
    const std::size_t at = (from + step) % text.size();
    if (!is_digit(text[at]) || (at > 0 && (is_word(text[at - 1]) || text[at - 1] == '.'))) continue;
    Range number = run_around(text, at, [](char c) {
      return is_digit(c) || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
    });
    while (number.begin < at && text[number.begin] != '-' && text[number.begin] != '+')
      ++number.begin;
    return number;
  }
  return {};
}

std::string whole_number(std::int64_t old, Chance& chance) {
  constexpr std::array<std::int64_t, 12> telling{
      0, 1, 2, 3, -1, 127, 255, 65535, 65536, 2147483647, 4294967295, -2147483648};
  switch (chance.below(4)) {
    case 0:
      return std::to_string(telling[chance.below(telling.size())]);
    case 1:
      return std::to_string(chance.below(8));
    default:
      // Unsigned, as numbers may be the largest that there are.
      return std::to_string(
          static_cast<std::int64_t>(static_cast<std::uint64_t>(old) + chance.below(7) - 3));
  }
}

std::string real_number(double old, const Style& style, Chance& chance) {
  constexpr std::array telling{"0",      "-0.0", "1e308", "-1e308", "1e-320",
                               "5e-324", "0.1",  "1e16",  "1e-9",   "123456789.125"};
  if (!style.json_numbers && chance.one_in(20))
    return std::array{"nan", "inf", "-inf", "+1", "1e999", "0x10"}[chance.below(6)];
  if (chance.one_in(3)) return telling[chance.below(telling.size())];
  constexpr std::array factors{-1.0, 0.5, 2.0, 10.0, 0.1, 1.0000001, 1e3, 1e-3};
  const double value = chance.one_in(2)
                           ? old * factors[chance.below(factors.size())]
                           : old + 1e-3 * (static_cast<double>(chance.below(2001)) - 1000);
  if (!std::isfinite(value)) return "1e300";
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::string another_number(std::string_view text, Range number, const Style& style,
                           Chance& chance) {
  if (chance.one_in(6)) {
    const Range other = find_number(text, chance.below(text.size()));
    return std::string(text.substr(other.begin, other.size()));
  }
  const std::string_view old = text.substr(number.begin, number.size());
  std::int64_t whole = 0;
  const auto parsed = std::from_chars(old.data(), old.data() + old.size(), whole);
  if (parsed.ec == std::errc{} && parsed.ptr == old.data() + old.size() && !chance.one_in(4))
    return whole_number(whole, chance);
  double real = 0;
  if (std::from_chars(old.data(), old.data() + old.size(), real).ec != std::errc{}) real = 1;
  return real_number(real, style, chance);
}

std::string replaced(std::string_view text, Range range, std::string_view by) {
  std::string result(text.substr(0, range.begin));
  result += by;
  result += text.substr(range.end);
  return result;
}

/// With its line end.
Range line_at(std::string_view text, std::size_t at) {
  Range line = run_around(text, at, [](char c) { return c != '\n'; });
  if (line.end < text.size()) ++line.end;
  return line;
}

std::string change_lines(std::string_view text, Chance& chance) {
  const Range one = line_at(text, chance.below(text.size()));
  const Range other = line_at(text, chance.below(text.size()));
  const std::string_view copy = text.substr(other.begin, other.size());
  switch (chance.below(3)) {
    case 0:
      return replaced(text, one, "");
    case 1:
      return replaced(text, {one.begin, one.begin}, copy);
    default:
      return replaced(text, one, copy);
  }
}

/// A word becomes another word of the text, or changes its letters.
std::string change_word(std::string_view text, Chance& chance) {
  const Range word = run_around(text, chance.below(text.size()), is_word);
  const Range other = run_around(text, chance.below(text.size()), is_word);
  if (chance.one_in(2)) return replaced(text, word, text.substr(other.begin, other.size()));
  return replaced(text, word,
                  chance.change_bytes(std::string(text.substr(word.begin, word.size()))));
}

std::string mutate(std::string_view text, const Style& style, Chance& chance) {
  if (text.empty()) return chance.change_bytes("");
  std::size_t at = chance.below(text.size());
  if (chance.one_in(4)) {  // data in base64 are short beside the text that describes them
    constexpr std::string_view mark = "base64,";
    const std::size_t found = text.find(mark, at);
    if (found != std::string_view::npos) at = found + mark.size();
  }
  constexpr std::size_t least_blob = 40;
  const Range blob = run_around(text, at, is_base64);
  if (blob.size() >= least_blob) {
    const auto bytes = io::decode_base64(text.substr(blob.begin, blob.size()));
    if (bytes) return replaced(text, blob, io::encode_base64(mutate_numbers(*bytes, chance)));
  }
  const std::size_t kind = chance.below(20);
  if (kind < 14) {
    const Range number = find_number(text, at);
    if (number.size() > 0)
      return replaced(text, number, another_number(text, number, style, chance));
  }
  if (kind < 17 && style.whole_lines) return change_lines(text, chance);
  return change_word(text, chance);
}

}  // namespace

std::string Chance::change_bytes(std::string bytes) {
  if (change_bytes_) return change_bytes_(std::move(bytes));
  const std::size_t at = below(bytes.size() + 1);
  const auto byte = static_cast<char>(below(256));
  if (at < bytes.size() && one_in(2)) bytes[at] = byte;
  else bytes.insert(at, 1, byte);
  return bytes;
}

std::string mutate_text(std::string_view content, Chance& chance) {
  return mutate(content, {}, chance);
}

std::string mutate_counted_text(std::string_view content, Chance& chance) {
  return mutate(content, {.whole_lines = chance.one_in(8)}, chance);
}

std::string mutate_json(std::string_view content, Chance& chance) {
  return mutate(content, {.whole_lines = chance.one_in(8), .json_numbers = true}, chance);
}

}  // namespace surf::test
