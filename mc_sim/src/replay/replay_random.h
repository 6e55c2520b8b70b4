// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "surf/core/random.h"
#include "transport/random_streams.h"

namespace surf::mc {

/// Which primary is replayed: what its random numbers depend on, and what it replays.
struct ReplayedPrimary {
  std::uint64_t seed = 1;
  std::uint64_t pixel = 0;  ///< below 2^48, like `electron`
  std::uint64_t electron = 0;
  std::size_t cascade = 0;  ///< of the material that it enters
  double azimuth = 0;       ///< of the cascade about its first direction, in turns, [0, 1)
};

/// Random numbers of a replayed primary, a function of the primary and of where in the cascade they
/// are drawn: in two specimens that are nearly alike the same cascade meets nearly the same fate.
class ReplayRandom {
 public:
  void begin(const ReplayedPrimary& p) {
    key_ = {{static_cast<std::uint32_t>(p.seed), static_cast<std::uint32_t>(p.seed >> 32)}};
    counter_ = {{0, static_cast<std::uint32_t>(p.electron), static_cast<std::uint32_t>(p.pixel),
                 static_cast<std::uint32_t>(p.pixel >> 32) << 16 |
                     static_cast<std::uint32_t>(p.electron >> 32)}};
    at(0);
  }

  /// From now on draws belong to `event`, counted modulo 2^23.
  void at(std::uint32_t event) {
    counter_[0] = random_streams::first_replay_block |
                  (event << 8 & (random_streams::first_replay_block - 1));
    left_ = 0;
  }

  double uniform() {
    if (left_ == 0) {
      block_ = random_block(key_, counter_);
      ++counter_[0];
      left_ = 4;
    }
    return (block_[static_cast<std::size_t>(--left_)] + 0.5) * 0x1p-32;
  }

 private:
  std::array<std::uint32_t, 2> key_{};
  std::array<std::uint32_t, 4> counter_{};
  std::array<std::uint32_t, 4> block_{};
  int left_ = 0;
};

/// A random azimuth for a primary, in turns.
inline double azimuth_of(const ReplayedPrimary& primary) {
  ReplayRandom random;
  random.begin(primary);
  random.at(1);  // no vertex comes first in a cascade
  return random.uniform();
}

}  // namespace surf::mc
