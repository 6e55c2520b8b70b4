// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose.h"

#include <limits>
#include <random>

#include "surf/core/random.h"

namespace surf::mc {

namespace {

// Streams beyond those of electrons, of which a pixel has at most 2^31.
constexpr std::uint64_t dose_stream = std::uint64_t{1} << 40;
constexpr std::uint64_t detector_stream = dose_stream + 1;

// A stream as the standard library's distributions take it.
struct Bits {
  using result_type = std::uint32_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return random.bits(); }
  RandomStream random;
};

}  // namespace

std::int64_t primaries_of_pixel(double dose, std::uint64_t seed, std::uint64_t pixel) {
  Bits bits{RandomStream(seed, pixel, dose_stream)};
  return std::poisson_distribution<std::int64_t>(dose)(bits);
}

std::int64_t detected(std::int64_t electrons, double efficiency, std::uint64_t seed,
                      std::uint64_t pixel, std::uint64_t detector) {
  if (efficiency >= 1) return electrons;
  Bits bits{RandomStream(seed, pixel, detector_stream + detector)};
  return std::binomial_distribution<std::int64_t>(electrons, efficiency)(bits);
}

}  // namespace surf::mc
