// SPDX-License-Identifier: GPL-3.0-or-later
#include "base64.h"

#include <array>
#include <cstdint>

namespace surf::io {
namespace {

constexpr std::string_view digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> make_values() {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < digits.size(); ++i) {
    values[static_cast<unsigned char>(digits[i])] = static_cast<std::int8_t>(i);
  }
  return values;
}

constexpr std::array<std::int8_t, 256> values = make_values();

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

std::string encode_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> std::uint32_t {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
    };
    const std::uint32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += digits[bits >> 18];
    text += digits[bits >> 12 & 63];
    text += i + 1 < bytes.size() ? digits[bits >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? digits[bits & 63] : '=';
  }
  return text;
}

std::optional<std::string> decode_base64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;  // bits held
  std::size_t used = 0, padding = 0;
  for (const char c : text) {
    if (is_blank(c)) continue;
    if (c == '=') {
      ++padding;
      continue;
    }
    const std::int8_t value = values[static_cast<unsigned char>(c)];
    if (value < 0 || padding > 0) return {};
    bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xffffff;
    count += 6;
    ++used;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count & 0xff));
    }
  }
  // A single digit left over holds no byte; padding fills the last group of four or is left out.
  const bool is_whole =
      used % 4 != 1 && (padding == 0 || (padding < 3 && (used + padding) % 4 == 0));
  if (!is_whole) return {};
  return bytes;
}

/// Four digits, the last one or two of which may be padding.
bool Base64Reader::next_group() {
  std::uint32_t bits = 0;
  int digits_read = 0, padding = 0;
  while (digits_read < 4) {
    if (position_ == text_.size()) return false;
    const char c = text_[position_++];
    if (is_blank(c)) continue;
    const std::int8_t value = c == '=' ? std::int8_t{0} : values[static_cast<unsigned char>(c)];
    if (value < 0 || (padding > 0 && c != '=')) return false;
    if (c == '=' && ++padding > 2) return false;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    ++digits_read;
  }
  for (int i = 0; i < 3 - padding; ++i) {
    held_.push_back(static_cast<char>(bits >> (16 - 8 * i) & 0xff));
  }
  return true;
}

std::optional<std::string> Base64Reader::take(std::size_t bytes) {
  if (bytes > most()) return {};
  while (held_.size() < bytes) {
    if (!next_group()) return {};
  }
  std::string taken = held_.substr(0, bytes);
  held_.erase(0, bytes);
  return taken;
}

}  // namespace surf::io
