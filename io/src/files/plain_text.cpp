// SPDX-License-Identifier: GPL-3.0-or-later
#include "plain_text.h"

#include <algorithm>
#include <cstdint>

#include "surf/core/error.h"
#include "text_scanner.h"

namespace surf::io {
namespace {

/// The bytes of the character at the front; 0 where there is none that may be.
std::size_t character_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) {
    const bool is_control = first < 0x20 && first != '\t' && first != '\n' && first != '\r';
    return is_control || first == 0x7F ? 0 : 1;
  }
  const std::size_t bytes = first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  std::uint32_t code = first & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if (next >> 6 != 2) return 0;
    code = code << 6 | (next & 0x3Fu);
  }
  const std::uint32_t least = bytes == 2 ? 0x80 : bytes == 3 ? 0x800 : 0x10000;
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool is_no_character = code == 0xFFFE || code == 0xFFFF;  // XML 1.0, 2.2
  return code < least || code > 0x10FFFF || is_surrogate || is_no_character ? 0 : bytes;
}

}  // namespace

bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::string as_plain_text(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0) plain += "\xEF\xBF\xBD";
    else plain += text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return plain;
}

void check_plain_text(std::string_view text, const std::string& what, const std::string& file) {
  if (is_plain_text(text)) return;
  throw InvalidInput(file, what + " ('" + shown(text) + "') is not text in UTF-8",
                     "Give it in UTF-8, without control characters");
}

}  // namespace surf::io
