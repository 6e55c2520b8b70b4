// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace surf::mc {

// How many primaries a pixel gets where an accuracy is wanted: the worker that spends them and what
// foretells their number agree here.

inline constexpr std::int64_t pilot_primaries = 24;    ///< only tell how many it needs
inline constexpr std::int64_t fewest_primaries = 32;   ///< whose counts are kept
inline constexpr double reserve_of_primaries = 1.1;    ///< over what the estimate of variance asks for

}  // namespace surf::mc
