// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <numeric>

#include "surf/mc/cascade_library.h"

namespace surf::mc {

/// The order in which a pixel takes cascades from a library: small runs of neighbours, at places that
/// are the pixel's own, none twice before all were taken. Cascades are independent of each other, so
/// any choice that does not look at them is as good as a random one.
class Subset {
 public:
  static constexpr std::uint64_t run = 8;
  static_assert(CascadeLibrary::page_cascades % run == 0);

  /// `a` and `b` are random words; `cascades` a multiple of `run`.
  Subset(std::uint64_t cascades, std::uint32_t a, std::uint32_t b)
      : runs_(cascades / run), first_(a % runs_), step_(1 + b % runs_) {
    while (std::gcd(step_, runs_) != 1) ++step_;
  }

  std::size_t operator[](std::uint64_t i) const {
    const std::uint64_t k = (first_ + i / run % runs_ * step_) % runs_;
    return static_cast<std::size_t>(k * run + i % run);
  }

 private:
  std::uint64_t runs_, first_, step_;
};

}  // namespace surf::mc
