// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/formula.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/mc/physics/element.h"

namespace surf::mc {

namespace {

constexpr std::size_t max_length = 200;  // letters; groups then nest no deeper than the stack likes
constexpr double max_count = 1e6;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

class Reader {
 public:
  Reader(std::string_view text, std::string_view subject) : text_(text), subject_(subject) {
    if (text.empty()) fail("the formula is empty");
    if (text.size() > max_length)
      fail(fmt::format("the formula has {} letters, more than {}", text.size(), max_length));
  }

  std::vector<FormulaPart> read() {
    std::vector<FormulaPart> parts = group('\0');
    if (at_ < text_.size()) fail(fmt::format("'{}' closes nothing", text_[at_]));
    return parts;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw UsageError(
        std::string(subject_),
        fmt::format("{}, at letter {} of '{}'", reason, at_ + 1, text_.substr(0, max_length)),
        "Write a formula such as SiO2, Ca(OH)2 or Al0.3Ga0.7As");
  }

  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  std::vector<FormulaPart> group(char closing) {
    std::vector<FormulaPart> parts;
    while (at_ < text_.size() && next() != ')' && next() != ']' && next() != '}') {
      const char c = next();
      if (is_upper(c)) {
        const int z = symbol();
        add(parts, {{z, 1.0}}, count());
        continue;
      }
      const char close = c == '(' ? ')' : c == '[' ? ']' : c == '{' ? '}' : '\0';
      if (!close) fail(fmt::format("'{}' is neither an element nor a bracket", c));
      ++at_;
      const std::vector<FormulaPart> inner = group(close);
      if (next() != close) fail(fmt::format("'{}' is missing", close));
      ++at_;
      add(parts, inner, count());
    }
    if (parts.empty()) fail(closing ? "the brackets are empty" : "there is no element");
    return parts;
  }

  int symbol() {
    for (const std::size_t length : {std::size_t{2}, std::size_t{1}}) {
      const std::string_view candidate = text_.substr(at_, length);
      if (candidate.size() < length || (length == 2 && !is_lower(candidate[1]))) continue;
      if (const Element* e = find_element(candidate)) {
        at_ += length;
        return e->atomic_number;
      }
      break;  // "Xx" is a mistake, not X and something else
    }
    fail(
        fmt::format("there is no element '{}'",
                    text_.substr(at_, at_ + 1 < text_.size() && is_lower(text_[at_ + 1]) ? 2 : 1)));
  }

  // 1 where none is written.
  double count() {
    if (!is_digit(next()) && next() != '.') return 1;
    std::size_t end = at_;
    while (end < text_.size() && (is_digit(text_[end]) || text_[end] == '.')) ++end;
    double value = 0;
    const auto [stop, error] = std::from_chars(text_.data() + at_, text_.data() + end, value);
    if (error != std::errc() || stop != text_.data() + end || !(value > 0) || value > max_count)
      fail(fmt::format("'{}' is not a count above 0", text_.substr(at_, end - at_)));
    at_ = end;
    return value;
  }

  static void add(std::vector<FormulaPart>& to, const std::vector<FormulaPart>& parts,
                  double times) {
    for (const FormulaPart& part : parts) {
      const auto found = std::find_if(to.begin(), to.end(), [&](const FormulaPart& p) {
        return p.atomic_number == part.atomic_number;
      });
      if (found == to.end()) to.push_back({part.atomic_number, times * part.atoms});
      else found->atoms += times * part.atoms;
    }
  }

  std::string_view text_;
  std::string_view subject_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<FormulaPart> parse_formula(std::string_view text, std::string_view subject) {
  return Reader(text, subject).read();
}

}  // namespace surf::mc
