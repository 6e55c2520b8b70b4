// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/substrate_noise.h"

#include <cmath>

#include "statistics.h"
#include "surf/core/error.h"
#include "surf/core/random.h"

namespace surf {
namespace {

TEST(SubstrateNoise, IsThatBetweenTheFeatures) {
  const AfmNoise noise{0.7, 0.05};
  test::Sample alpha, sigma;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HeightField f;
    f.z_nm = simulate_noise(noise, 128, 128, seed);
    RandomStream random(seed, 1, 0);
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x) f.z_nm(x, y) += 0.3 * x + 5;
    for (int i = 0; i < 20; ++i) {
      const int left = static_cast<int>(112 * random.uniform()),
                low = static_cast<int>(112 * random.uniform());
      const double top = 10 + 20 * random.uniform();
      for (int y = low; y < low + 16; ++y)
        for (int x = left; x < left + 16; ++x) f.z_nm(x, y) += top;
    }
    const SubstrateNoise s = estimate_substrate_noise(f);
    EXPECT_EQ(s.plane.verdict, HoughVerdict::clear);
    EXPECT_LT(s.substrate_share, 0.9);
    alpha.add(s.estimate.noise.alpha);
    sigma.add(s.estimate.sigma_nm());
  }
  const double truth = std::sqrt(noise.variance_nm2());
  test::expect_mean(alpha.mean(), alpha.standard_error(), noise.alpha, 2, 0.01);
  test::expect_mean(sigma.mean(), sigma.standard_error(), truth, 2, 0.02 * truth);
}

TEST(SubstrateNoise, RefusesNothing) {
  HeightField f;
  f.z_nm = Grid<double>(20, 20);
  EXPECT_THROW(estimate_substrate_noise(f, {}, Mask(20, 20, 0)), InvalidInput);
  EXPECT_EQ(estimate_substrate_noise(f).estimate.noise.innovation_nm2, 0);
}

}  // namespace
}  // namespace surf
