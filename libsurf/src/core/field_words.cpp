// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/field_words.h"

#include <algorithm>

namespace surf {
namespace {

bool is_small(char c) { return c >= 'a' && c <= 'z'; }

bool is_field(std::string_view name) {
  char before = '.';
  for (const char c : name) {
    const bool good =
        is_small(c) || (before != '.' && (c == '_' || c == '.' || (c >= '0' && c <= '9')));
    if (!good) return false;
    before = c;
  }
  return before != '.';
}

}  // namespace

std::string with_field_words(std::string_view text, const FieldWord& word) {
  std::string out;
  for (std::size_t from = 0;;) {
    const std::size_t open = text.find('`', from);
    const std::size_t close = open == text.npos ? open : text.find('`', open + 1);
    if (close == text.npos) return out.append(text.substr(from));
    const std::string_view inside = text.substr(open + 1, close - open - 1);
    const std::string_view field = inside.substr(0, inside.find('='));
    if (!is_field(field)) {  // the closing backtick may open a field
      out.append(text.substr(from, close - from));
      from = close;
      continue;
    }
    out.append(text.substr(from, open - from));
    out += word(field, inside.substr(std::min(field.size() + 1, inside.size())));
    from = close + 1;
  }
}

std::string last_part(std::string_view field, char space) {
  std::string part(field.substr(field.rfind('.') + 1));
  std::replace(part.begin(), part.end(), '_', space);
  return part;
}

}  // namespace surf
