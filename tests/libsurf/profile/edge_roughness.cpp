// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/edge_roughness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm/normal_numbers.h"
#include "surf/core/error.h"

namespace surf {
namespace {

/// An edge whose roughness has an exponential correlation (H = 1/2), and noise.
std::vector<double> edge(double sigma, double correlation_nm, double noise, int rows,
                         double distance_nm, std::uint64_t seed) {
  NormalNumbers normal(seed, 5);
  const double keep = std::exp(-distance_nm / correlation_nm);
  std::vector<double> out;
  double now = sigma * normal();
  for (int i = 0; i < rows; ++i) {
    out.push_back(now + noise * normal());
    now = keep * now + sigma * std::sqrt(1 - keep * keep) * normal();
  }
  return out;
}

TEST(EdgeRoughness, ASpectrumOfNoiseIsFlatAndHoldsItsVariance) {
  std::vector<std::vector<double>> edges;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) edges.push_back(edge(0, 10, 2, 128, 4, seed));
  const EdgeSpectrum s = edge_spectrum(edges, 4);
  ASSERT_EQ(s.density_nm3.size(), 63u);
  EXPECT_NEAR(s.frequency_per_nm.front(), 1 / 512.0, 1e-12);
  double low = 0, high = 0;
  for (std::size_t i = 2; i < 32; ++i) low += s.density_nm3[i] / 30;
  for (std::size_t i = 32; i < 62; ++i) high += s.density_nm3[i] / 30;
  EXPECT_NEAR(low, 16, 0.8);
  EXPECT_NEAR(high, 16, 0.8);
}

TEST(EdgeRoughness, DensitiesHoldTheVariance) {
  EdgeRoughness r;
  r.sigma_nm = 1.5, r.correlation_nm = 20, r.hurst = 0.7, r.noise_nm = 0;
  double sum = 0;
  constexpr double step = 1e-5;
  for (double f = 0.5 * step; f < 0.5; f += step) sum += 2 * step * roughness_density(r, f, 1);
  EXPECT_NEAR(sum, 2.25, 0.02);
}

TEST(EdgeRoughness, IsFoundWithoutTheNoise) {
  double inside = 0, off = 0, biased = 0, error = 0;
  constexpr int trials = 30;
  for (std::uint64_t seed = 1; seed <= trials; ++seed) {
    std::vector<std::vector<double>> edges;
    for (std::uint64_t e = 0; e < 4; ++e) edges.push_back(edge(1, 25, 0.8, 256, 4, seed * 10 + e));
    const EdgeRoughness r = fit_roughness(edge_spectrum(edges, 4), 4, 4);
    EXPECT_TRUE(r.found);
    off += (r.sigma_nm - 1) / trials;
    biased += r.biased_sigma_nm / trials;
    error += r.sigma_error_nm / trials;
    inside += std::abs(r.sigma_nm - 1) <= 2 * r.sigma_error_nm;
  }
  EXPECT_NEAR(off, 0, 0.08);
  EXPECT_GT(biased, 1.15);  // with the noise
  EXPECT_GE(inside, 25);    // 95 % of 30 would be 28.5
  EXPECT_LT(error, 0.2);
}

TEST(EdgeRoughness, NoiseAloneIsNoRoughness) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    found += fit_roughness(edge_spectrum({edge(0, 10, 1, 128, 4, seed)}, 4), 1, 4).found;
  EXPECT_LE(found, 3);
}

TEST(EdgeRoughness, RefusesWhatHasNoSpectrum) {
  EXPECT_THROW(edge_spectrum({}, 1), InvalidInput);
  EXPECT_THROW(edge_spectrum({std::vector<double>(15, 0)}, 1), InvalidInput);
  EXPECT_THROW(edge_spectrum({std::vector<double>(20, 0), std::vector<double>(21, 0)}, 1),
               InvalidInput);
  EXPECT_THROW(edge_spectrum({std::vector<double>(20, std::nan(""))}, 1), InvalidInput);
}

}  // namespace
}  // namespace surf
