// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/shot_noise.h"

#include "surf/core/distributions.h"
#include "transport/random_streams.h"

namespace surf::mc {

std::int64_t detected(std::int64_t electrons, double efficiency, std::uint64_t seed,
                      std::uint64_t pixel, std::uint64_t detector) {
  if (efficiency >= 1) return electrons;
  RandomStream random(seed, pixel, random_streams::shot_noise + detector);
  return binomial(electrons, efficiency, random);
}

}  // namespace surf::mc
