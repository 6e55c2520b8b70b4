// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>

#include "surf/mc/geometry/beam.h"
#include "surf/mc/request/simulation_options.h"

namespace surf::mc {

/// How many primaries each pixel gets, where that is settled beforehand: a fixed number, one
/// from a Poisson distribution that is a function of seed and pixel, or the options' own.
class PrimariesPerPixel {
 public:
  PrimariesPerPixel(const Scan& scan, const SimulationOptions& options);

  std::int64_t of(int x, int y) const;

  /// The number of its first primary.
  std::int64_t first(int x, int y) const { return numbers_ ? numbers_->first(x, y) : 0; }

  /// The pixel's number: its coordinate of random streams.
  std::uint64_t number(int x, int y) const {
    return static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width_) +
           static_cast<std::uint64_t>(x);
  }

 private:
  int width_;
  std::int64_t electrons_;
  double dose_;
  std::uint64_t seed_;
  std::shared_ptr<const PrimaryNumbers> numbers_;
};

/// From a mean of `dose`.
std::int64_t primaries_of_pixel(double dose, std::uint64_t seed, std::uint64_t pixel);

}  // namespace surf::mc
