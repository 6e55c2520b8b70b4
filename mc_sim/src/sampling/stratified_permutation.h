// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include "surf/mc/cascades/cascade_library.h"

namespace surf::mc {

/// The order in which a pixel takes cascades from a library: one small run of neighbours from each
/// block in turn, beginning with a block and at places within the blocks that are the pixel's own;
/// none twice before all were taken. Cascades are independent of each other, so any choice that
/// does not look at them is as good as a random one. Pixels that are served together go through the
/// library block by block, so that the processor's cache holds what they replay.
class StratifiedPermutation {
 public:
  static constexpr std::uint64_t run = 32, block = 64;
  static_assert(CascadeLibrary::page_cascades % block == 0 && block % run == 0);

  /// `a` and `b` are random words; `cascades` a multiple of `block`.
  StratifiedPermutation(std::uint64_t cascades, std::uint32_t a, std::uint32_t b)
      : blocks_(cascades / block), first_(blocks_ > 0 ? a % blocks_ : 0), key_(b) {}

  /// The cascade of the pixel's primary `i`.
  std::size_t operator[](std::uint64_t i) const {
    const std::uint64_t turn = i / run;
    const std::uint64_t b = (first_ + turn) % blocks_;
    const std::uint64_t place = (offset(b) + turn / blocks_) % runs;
    return static_cast<std::size_t>(b * block + place * run + i % run);
  }

  /// take(i, cascade) for each primary from `first` to before `end` whose cascade is of this block.
  template <class Take>
  void each_of_block(std::uint64_t b, std::uint64_t first, std::uint64_t end,
                     const Take& take) const {
    std::uint64_t turn = (b + blocks_ - first_) % blocks_;
    const std::uint64_t begin = first / run;
    if (turn < begin) turn += (begin - turn + blocks_ - 1) / blocks_ * blocks_;
    for (; turn * run < end; turn += blocks_) {
      const std::uint64_t place = (offset(b) + turn / blocks_) % runs;
      for (std::uint64_t i = std::max(first, turn * run); i < std::min(end, (turn + 1) * run); ++i)
        take(i, static_cast<std::size_t>(b * block + place * run + i % run));
    }
  }

 private:
  static constexpr std::uint64_t runs = block / run;

  std::uint64_t offset(std::uint64_t b) const { return ((key_ + b) * 0x9e3779b97f4a7c15u) >> 40; }

  std::uint64_t blocks_, first_, key_;
};

}  // namespace surf::mc
