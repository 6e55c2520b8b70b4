// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling/primaries_per_pixel.h"

#include "surf/core/distributions.h"
#include "transport/random_streams.h"

namespace surf::mc {

PrimariesPerPixel::PrimariesPerPixel(const Scan& scan, const SimulationOptions& o)
    : width_(scan.width), electrons_(electrons_of(o.budget)), dose_(dose_of(o.budget)),
      seed_(o.seed), numbers_(o.primaries) {}

std::int64_t PrimariesPerPixel::of(int x, int y) const {
  if (numbers_) return numbers_->end(x, y) - numbers_->first(x, y);
  return dose_ > 0 ? primaries_of_pixel(dose_, seed_, number(x, y)) : electrons_;
}

std::int64_t primaries_of_pixel(double dose, std::uint64_t seed, std::uint64_t pixel) {
  RandomStream random(seed, pixel, random_streams::dose);
  return poisson(dose, random);
}

}  // namespace surf::mc
