// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace surf {

/// Four uniform 32-bit words that are a function of key and counter: Philox4x32 with 7 rounds, the
/// smallest number of rounds that passes all of BigCrush (Salmon et al., SC11,
/// doi:10.1145/2063384.2063405).
std::array<std::uint32_t, 4> random_block(const std::array<std::uint32_t, 2>& key,
                                          const std::array<std::uint32_t, 4>& counter);

/// A stream of random numbers that is a pure function of (seed, pixel, electron): Philox4x32-10
/// (Salmon et al., SC11, doi:10.1145/2063384.2063405). It does not depend on threads, tiles or
/// ranks. Streams with different keys are independent for all practical purposes.
class RandomStream {
 public:
  /// `pixel` and `electron` must be below 2^48.
  RandomStream(std::uint64_t seed, std::uint64_t pixel, std::uint64_t electron);

  /// A uniform 32-bit word.
  std::uint32_t bits() {
    if (next_ == buffer_words) refill();
    return buffer_[next_++];
  }

  /// Uniform in (0, 1), both ends excluded; multiples of 2^-33.
  double uniform() { return (bits() + 0.5) * 0x1p-32; }

 private:
  static constexpr int buffer_words = 64;

  void refill();

  int next_ = buffer_words;
  std::uint32_t block_ = 0;
  std::uint32_t key_[2];
  std::uint32_t counter_[3];
  alignas(64) std::uint32_t buffer_[buffer_words];
};

}  // namespace surf
