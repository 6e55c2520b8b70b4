// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace surf {

/// Whether every |value| <= `most` (> 0) and no value is NaN. The loop has no branches: it is meant
/// for millions of values that usually pass.
inline bool all_within(std::span<const double> values, double most) {
  // With the sign bit cleared, doubles order like their bits as integers, and NaN comes last.
  constexpr std::int64_t without_sign = 0x7fffffffffffffff;
  const auto limit = std::bit_cast<std::int64_t>(most);
  std::int64_t below_0_if_beyond = 0;
  for (const double v : values)
    below_0_if_beyond |= limit - (std::bit_cast<std::int64_t>(v) & without_sign);
  return below_0_if_beyond >= 0;
}

}  // namespace surf
