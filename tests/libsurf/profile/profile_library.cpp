// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/profile/profile_library.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm/normal_numbers.h"
#include "profile/library_of.h"
#include "surf/core/error.h"

namespace surf {
namespace {

const ProfileBox box{{80, 100, 86, 4, 3}, {5, 0, 4, 3, 2}};

double quadratic(double u, const ProfileNumbers& n) {
  const double w = n[profile_width] - 80, a = n[profile_angle] - 86, t = n[profile_top] - 4,
               f = n[profile_foot] - 3;
  return std::sin(0.2 * u) + 0.1 * w + 0.05 * a * std::cos(0.3 * u) + 0.02 * a * a + 0.03 * t * f -
         0.01 * t * t * u / 10;
}

ProfileLibrary library() { return test::library_of(box, -20, 20, quadratic); }

TEST(ProfileLibrary, ADesignFillsItsBoxAndHoldsWhatIsFixed) {
  const auto shapes = profile_design(box);
  EXPECT_GE(shapes.size(), 30u);
  EXPECT_EQ(shapes.front(), box.middle);
  double low = 100, high = 0;
  for (const ProfileNumbers& n : shapes) {
    EXPECT_EQ(n[profile_height], 100);
    for (std::size_t k = 0; k < profile_numbers; ++k)
      EXPECT_LE(std::abs(n[k] - box.middle[k]), box.half[k] + 1e-12);
    low = std::min(low, n[profile_angle]), high = std::max(high, n[profile_angle]);
  }
  EXPECT_LT(low, 83);
  EXPECT_GT(high, 89);
}

TEST(ProfileLibrary, KnowsQuadraticsExactlyAndItsDerivatives) {
  const ProfileLibrary lib = library();
  ProfileNumbers n{82, 100, 84.5, 5, 2.2};
  EXPECT_NEAR(lib.at(3.5, n).value, quadratic(3.5, n), 1e-9);
  for (const double variance : lib.variances()) EXPECT_NEAR(variance, 0, 1e-15);
  const double u = 3.27, step = 1e-5;
  EXPECT_NEAR(lib.at(u, n).value, quadratic(u, n), 1e-4);
  const ProfileLibrary::Value v = lib.at(u, n);
  EXPECT_NEAR(v.by_u, (lib.at(u + step, n).value - lib.at(u - step, n).value) / (2 * step), 1e-6);
  EXPECT_NEAR(v.by_u2, (lib.at(u + step, n).by_u - lib.at(u - step, n).by_u) / (2 * step), 1e-5);
  for (const std::size_t k : {profile_width, profile_angle, profile_top, profile_foot}) {
    ProfileNumbers up = n, down = n;
    up[k] += step, down[k] -= step;
    EXPECT_NEAR(v.by_number[k], (lib.at(u, up).value - lib.at(u, down).value) / (2 * step), 1e-6);
  }
  EXPECT_EQ(v.by_number[profile_height], 0);
}

TEST(ProfileLibrary, AFinerMiddleGivesTheLevel) {
  const auto shapes = profile_design(box);
  std::vector<std::vector<double>> signals;
  for (const ProfileNumbers& n : shapes) {
    signals.emplace_back();  // all are off alike, as by the same random numbers
    for (int k = 0; k <= 80; ++k)
      signals.back().push_back(quadratic(-20 + 0.5 * k, n) + 0.3 * std::sin(7.0 * k));
  }
  FinerMiddle middle{{}, std::vector<double>(81, 1e-4)};
  for (int k = 0; k <= 80; ++k) middle.signal.push_back(quadratic(-20 + 0.5 * k, box.middle));
  const ProfileLibrary lib(box, -20, 0.5, shapes, signals, middle);
  const ProfileNumbers n{82, 100, 84.5, 5, 2.2};
  EXPECT_NEAR(lib.at(3.5, n).value, quadratic(3.5, n), 1e-9);
  for (const double variance : lib.variances()) EXPECT_NEAR(variance, 1e-4, 1e-12);
  middle.variance.pop_back();
  EXPECT_THROW(ProfileLibrary(box, -20, 0.5, shapes, signals, middle), InvalidInput);
}

TEST(ProfileLibrary, NoiseOfSignalsIsNoEffectOfTheShape) {
  const auto shapes = profile_design(box);
  std::vector<std::vector<double>> signals;
  NormalNumbers normal(3, 1);
  for (const ProfileNumbers& n : shapes) {
    signals.emplace_back();  // the angle shows about u = 0 alone
    for (int k = 0; k <= 160; ++k)
      signals.back().push_back(
          1 + 0.1 * (n[profile_angle] - 86) * std::exp(-std::pow(0.25 * k - 20, 2)) +
          0.1 * normal());
  }
  const ProfileLibrary lib(box, -40, 0.5, shapes, signals);
  double far = 0;
  for (double u = -39; u < -10; u += 0.5)
    far += std::pow(lib.at(u, box.middle).by_number[profile_angle], 2) / 58;
  // One place knows the slope to 0.1 / (4 / sqrt(3)) / sqrt(38) = 0.007 per degree.
  EXPECT_LT(std::sqrt(far), 0.0045);
  EXPECT_NEAR(lib.at(0, box.middle).by_number[profile_angle], 0.1, 0.03);
}

TEST(ProfileLibrary, ErrorsOfBlurredSignalsAreThoseBeforeTheBlur) {
  const auto shapes = profile_design(box);
  const std::vector<double> weights = blur_weights(1.5);
  double sum = weights[0];
  for (std::size_t k = 1; k < weights.size(); ++k) sum += 2 * weights[k];
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(blur_weights(0), std::vector<double>{1});
  constexpr double noise = 0.1;
  constexpr int places = 400;
  NormalNumbers normal(3, 1);
  std::vector<std::vector<double>> sharp, blurred;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const int reach = static_cast<int>(weights.size()) - 1;
    std::vector<double> wide;
    for (int u = -reach; u < places + reach; ++u) wide.push_back(1 + noise * normal());
    sharp.emplace_back(wide.begin() + reach, wide.end() - reach);
    blurred.emplace_back();
    for (int u = 0; u < places; ++u) {
      double value = 0;
      for (int k = -reach; k <= reach; ++k)
        value += weights[static_cast<std::size_t>(std::abs(k))] *
                 wide[static_cast<std::size_t>(u + reach + k)];
      blurred.back().push_back(value);
    }
  }
  const auto mean_variance = [](const ProfileLibrary& l) {
    double mean = 0;
    for (const double v : l.variances()) mean += v / places;
    return mean;
  };
  const double before = mean_variance({box, 0, 1, shapes, sharp}),
               after = mean_variance({box, 0, 1, shapes, blurred, {}, 1.5});
  EXPECT_NEAR(after / before, 1, 0.1);
}

TEST(ProfileLibrary, GoesOnLevelBeyondItsEnds) {
  const ProfileLibrary lib = library();
  EXPECT_NEAR(lib.at(500, box.middle).value, quadratic(20, box.middle), 1e-9);
  EXPECT_EQ(lib.at(500, box.middle).by_u, 0);
  EXPECT_NEAR(lib.at(-500, box.middle).value, quadratic(-20, box.middle), 1e-9);
}

TEST(ProfileLibrary, RefusesTooFewShapesAndValuesThatAreNone) {
  auto shapes = profile_design(box);
  std::vector<std::vector<double>> signals(shapes.size(), std::vector<double>(10, 1));
  signals[3][4] = std::nan("");
  EXPECT_THROW(ProfileLibrary(box, 0, 1, shapes, signals), InvalidInput);
  signals[3].pop_back();
  EXPECT_THROW(ProfileLibrary(box, 0, 1, shapes, signals), InvalidInput);
  shapes.resize(5), signals.resize(5);
  EXPECT_THROW(ProfileLibrary(box, 0, 1, shapes, signals), InvalidInput);
}

}  // namespace
}  // namespace surf
