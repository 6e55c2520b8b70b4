// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
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
  static constexpr std::uint64_t block = 64, long_run = 32, short_run = 1;
  static_assert(CascadeLibrary::page_cascades % block == 0);

  /// `a` and `b` are random words; `cascades` a multiple of `block`; `run` is a power of two that
  /// divides it. Short runs cost time: each is a place of its own in memory. But pixels whose means
  /// are compared or averaged should share few of them.
  StratifiedPermutation(std::uint64_t cascades, std::uint32_t a, std::uint32_t b,
                        std::uint64_t run = long_run)
      : blocks_(cascades / block), first_(blocks_ > 0 ? a % blocks_ : 0), key_(b),
        shift_(std::countr_zero(run)) {}

  /// The cascade of the pixel's primary `i`.
  std::size_t operator[](std::uint64_t i) const {
    const std::uint64_t turn = i >> shift_;
    return cascade((first_ + turn) % blocks_, turn, i);
  }

  /// take(i, cascade) for each primary from `first` to before `end` whose cascade is of this block.
  template <class Take>
  void each_of_block(std::uint64_t b, std::uint64_t first, std::uint64_t end,
                     const Take& take) const {
    std::uint64_t turn = (b + blocks_ - first_) % blocks_;
    const std::uint64_t begin = first >> shift_;
    if (turn < begin) turn += (begin - turn + blocks_ - 1) / blocks_ * blocks_;
    for (; turn << shift_ < end; turn += blocks_)
      for (std::uint64_t i = std::max(first, turn << shift_);
           i < std::min(end, (turn + 1) << shift_); ++i)
        take(i, cascade(b, turn, i));
  }

 private:
  std::size_t cascade(std::uint64_t b, std::uint64_t turn, std::uint64_t i) const {
    const std::uint64_t runs = block >> shift_;
    const std::uint64_t place = (offset(b) + turn / blocks_) % runs;
    return static_cast<std::size_t>(b * block + (place << shift_) +
                                    (i & ((std::uint64_t{1} << shift_) - 1)));
  }
  /// Of single cascades mixed well (the finalizer of splitmix64, Steele et al. 2014,
  /// doi:10.1145/2660193.2660195): pixels that take the same cascade of one block must not take the
  /// same of all others, as those of long runs do.
  std::uint64_t offset(std::uint64_t b) const {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15u;
    if (shift_ > 0) return (key_ + b) * odd >> 40;
    std::uint64_t x = (key_ << 32 | b) * odd;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x >> 32;
  }

  std::uint64_t blocks_, first_, key_;
  int shift_;
};

}  // namespace surf::mc
