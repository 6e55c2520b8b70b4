// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/random.h"

// Who draws from which stream, RandomStream(seed, pixel, electron). Nobody draws from one that is
// somebody else's: a new use gets its line here. Both coordinates end at 2^48.
namespace surf::mc::random_streams {

// The electron's coordinate, in the streams of one pixel.
inline constexpr std::uint64_t most_electrons = std::uint64_t{1}
                                                << 31;  ///< of a pixel: 0 to below it are primaries
inline constexpr std::uint64_t dose = std::uint64_t{1}
                                      << 40;           ///< how many primaries the pixel gets
inline constexpr std::uint64_t shot_noise = dose + 1;  ///< plus the detector's number, below 2^31
inline constexpr std::uint64_t order_of_cascades = std::uint64_t{1} << 42;
inline constexpr std::uint64_t first_handed_over = std::uint64_t{1} << 47;  ///< up to the end
inline constexpr std::uint64_t most_handed_over = std::uint64_t{1} << 16;   ///< by one primary

/// Of the `count`th electron that replay of a primary hands over to direct simulation, from 0.
constexpr std::uint64_t handed_over(std::uint64_t electron, std::uint64_t count) {
  return first_handed_over + count * most_electrons + electron;
}
static_assert(handed_over(most_electrons - 1, most_handed_over - 1) ==
              (std::uint64_t{1} << 48) - 1);

// The pixel's coordinate.
inline constexpr std::uint64_t planes =
    std::uint64_t{1} << 45;  ///< pixels of a scan lie below; up to 2^46 planar controls
inline constexpr std::uint64_t azimuths = std::uint64_t{1}
                                          << 46;  ///< of cascades on planar controls
inline constexpr std::uint64_t cascades = std::uint64_t{1} << 47;  ///< of libraries

// Within a stream: RandomStream takes blocks from 0 up, replay those from here on, by where in a
// cascade it draws.
inline constexpr std::uint32_t first_replay_block = std::uint32_t{1} << 31;

}  // namespace surf::mc::random_streams
