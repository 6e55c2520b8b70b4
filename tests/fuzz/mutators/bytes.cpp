// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "mutators.h"

namespace surf::test {
namespace {

/// A number of `size` bytes, as they lie in the file.
std::uint64_t number_at(const std::string& bytes, std::size_t at, std::size_t size, bool big) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= std::uint64_t{static_cast<unsigned char>(bytes[at + (big ? size - 1 - i : i)])}
             << 8 * i;
  return value;
}

void set_number(std::string& bytes, std::size_t at, std::size_t size, bool big,
                std::uint64_t value) {
  for (std::size_t i = 0; i < size; ++i)
    bytes[at + (big ? size - 1 - i : i)] = static_cast<char>(value >> 8 * i);
}

std::uint64_t another(std::uint64_t old, std::size_t size, Chance& chance) {
  constexpr std::array<std::uint64_t, 10> telling{
      0, 1, 2, 0xff, 0x7f, 0xffff, 0x7fff, 0x7fffffff, 0xffffffff, 0xffffffffffffffff};
  constexpr std::array reals{0.0, -0.0, 1.0, -1.0, 0.5, 1e-30, 1e30, 1e300, -1e300};
  switch (chance.below(6)) {
    case 0:
      return telling[chance.below(telling.size())];
    case 1: {
      const double real = reals[chance.below(reals.size())];
      return size == 8 ? std::bit_cast<std::uint64_t>(real)
                       : std::bit_cast<std::uint32_t>(static_cast<float>(real));
    }
    case 2:
      return old ^ std::uint64_t{1} << chance.below(8 * size);
    default:
      return old + chance.below(9) - 4;
  }
}

}  // namespace

std::string mutate_numbers(std::string_view content, Chance& chance) {
  std::string bytes(content);
  if (bytes.empty()) return chance.change_bytes(bytes);
  const std::size_t size =
      std::min(std::size_t{1} << chance.below(4), std::bit_floor(bytes.size()));
  // Numbers lie at multiples of their size as a rule, but not in all formats.
  std::size_t at = chance.below(bytes.size() - size + 1);
  if (chance.one_in(2)) at -= at % size;
  if (chance.one_in(8)) {
    const std::size_t from = chance.below(bytes.size() - size + 1);
    std::memmove(bytes.data() + at, bytes.data() + from, size);
    return bytes;
  }
  const bool big = chance.one_in(3);
  set_number(bytes, at, size, big, another(number_at(bytes, at, size, big), size, chance));
  return bytes;
}

}  // namespace surf::test
