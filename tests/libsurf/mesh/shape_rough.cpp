// SPDX-License-Identifier: GPL-3.0-or-later
// Self-affine surfaces and surfaces of a given spectrum: surf/mesh/shapes.h.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "surf/core/error.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

double mean_square(const Grid<double>& z) {
  double sum = 0;
  for (const double v : z.data()) sum += v * v;
  return sum / double(z.size());
}

/// Mean power along x at `waves` per field, over all rows (a plain sum, not the code's transform).
double power_along_x(const HeightField& f, int waves) {
  double sum = 0;
  for (int y = 0; y < f.z_nm.height(); ++y) {
    std::complex<double> amplitude = 0;
    for (int x = 0; x < f.z_nm.width(); ++x) {
      amplitude +=
          f.z_nm(x, y) * std::polar(1.0, -2 * std::numbers::pi * waves * x / f.z_nm.width());
    }
    sum += std::norm(amplitude);
  }
  return sum / f.z_nm.height();
}

}  // namespace

TEST(MakeSelfAffine, HasTheRmsAndZeroMean) {
  for (const double hurst : {0.2, 0.8, 1.0}) {
    const HeightField f = make_self_affine({99, 60, 1}, 3, 8, hurst, 4);
    EXPECT_NEAR(std::sqrt(mean_square(f.z_nm)), 3, 1e-12);
    double sum = 0;
    for (const double v : f.z_nm.data()) sum += v;
    EXPECT_NEAR(sum, 0, 1e-8);
  }
}

TEST(MakeSelfAffine, FallsWithItsExponent) {
  // Far beyond 1 / L the profile's spectrum, an integral over one direction, falls as f^-(1 + 2 H).
  for (const double hurst : {0.3, 0.8}) {
    const HeightField f = make_self_affine({999, 399, 1}, 1, 100, hurst, 9);
    double low = 0, high = 0;
    for (int k = 0; k < 12; ++k) {
      low += power_along_x(f, 20 + k);
      high += power_along_x(f, 4 * (20 + k));
    }
    EXPECT_NEAR(std::log(low / high) / std::log(4), 1 + 2 * hurst, 0.12) << hurst;
  }
}

TEST(MakeSelfAffine, TheSeedDecidesEverything) {
  const FieldExtent extent{60, 44, 1};
  EXPECT_EQ(make_self_affine(extent, 1, 5, 0.7, 3).z_nm,
            make_self_affine(extent, 1, 5, 0.7, 3).z_nm);
  EXPECT_NE(make_self_affine(extent, 1, 5, 0.7, 3).z_nm,
            make_self_affine(extent, 1, 5, 0.7, 4).z_nm);
}

TEST(MakeRoughFromSpectrum, HasTheSpectrumsPower) {
  // A ring of density 50 nm^4 between 0.05 and 0.1 per nm has the mean square 50 pi (0.1^2 -
  // 0.05^2).
  const std::vector<SpectralDensity> ring{{0.05, 50}, {0.1, 50}};
  const double truth = 50 * std::numbers::pi * (0.01 - 0.0025);
  for (const double pitch : {1.0, 2.0}) {
    const HeightField f = make_rough_from_spectrum({599, 499, pitch}, ring, 5);
    // 600 x 500 nm^2 hold 7,000 modes: their mean scatters by 1.7 %.
    EXPECT_NEAR(mean_square(f.z_nm), truth, 0.09 * truth);
    EXPECT_GT(power_along_x(f, 45), 0);
    EXPECT_LT(power_along_x(f, 100), 1e-12 * power_along_x(f, 45)) << "beyond the ring";
  }
}

TEST(MakeSelfAffine, RefusesBadArguments) {
  const FieldExtent extent{60, 40, 1};
  EXPECT_THROW(make_self_affine(extent, 0, 3, 0.5, 1), UsageError);
  EXPECT_THROW(make_self_affine(extent, 1, 0, 0.5, 1), UsageError);
  EXPECT_THROW(make_self_affine(extent, 1, 21, 0.5, 1), UsageError);
  for (const double hurst : {0.0, 1.1, -1.0, double(NAN)}) {
    EXPECT_THROW(make_self_affine(extent, 1, 3, hurst, 1), UsageError);
  }
  EXPECT_THROW(make_rough_from_spectrum(extent, {{0.1, 1}}, 1), UsageError);
  EXPECT_THROW(make_rough_from_spectrum(extent, {{0.1, 1}, {0.1, 2}}, 1), UsageError);
  EXPECT_THROW(make_rough_from_spectrum(extent, {{0, 1}, {0.1, 2}}, 1), UsageError);
  EXPECT_THROW(make_rough_from_spectrum(extent, {{0.05, -1}, {0.1, 2}}, 1), UsageError);
}

}  // namespace surf
