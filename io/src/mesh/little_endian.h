// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>

namespace surf::io {

/// Appends numbers as their little-endian bytes, on any machine.
class LittleEndian {
 public:
  explicit LittleEndian(std::string& bytes) : bytes_(bytes) {}

  void add(double value) { add_bits(std::bit_cast<std::uint64_t>(value), 8); }
  void add(float value) { add_bits(std::bit_cast<std::uint32_t>(value), 4); }
  void add(std::uint32_t value) { add_bits(value, 4); }
  void add(std::uint8_t value) { add_bits(value, 1); }

 private:
  void add_bits(std::uint64_t bits, std::size_t count) {
    std::array<char, 8> text;
    for (std::size_t i = 0; i < 8; ++i) text[i] = static_cast<char>(bits >> (8 * i) & 0xff);
    bytes_.append(text.data(), count);
  }

  std::string& bytes_;
};

}  // namespace surf::io
