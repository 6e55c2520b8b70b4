// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "surf/core/random.h"

namespace surf {

/// Independent standard normal numbers that are a function of (seed, row), by Box and Muller.
class NormalNumbers {
 public:
  NormalNumbers(std::uint64_t seed, std::uint64_t row) : random_(seed, row, 0) {}

  double operator()() {
    if (have_) {
      have_ = false;
      return kept_;
    }
    const double radius = std::sqrt(-2 * std::log(random_.uniform()));
    const double angle = 2 * std::numbers::pi * random_.uniform();
    kept_ = radius * std::sin(angle);
    have_ = true;
    return radius * std::cos(angle);
  }

 private:
  RandomStream random_;
  double kept_ = 0;
  bool have_ = false;
};

}  // namespace surf
