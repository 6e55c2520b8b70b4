// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/afm/tip_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double degree = std::numbers::pi / 180;
const TipSampling wide{0.5, 0.25, 61, 121};

double z(const Tip& tip, double x_nm, double y_nm) {
  return tip.z_nm(tip.apex_x + static_cast<int>(std::lround(x_nm / tip.pitch_x_nm)),
                  tip.apex_y + static_cast<int>(std::lround(y_nm / tip.pitch_y_nm)));
}

// The lowest point of a sphere of this radius rolling inside a sharp pyramid, by brute force.
double rolled(const Tip& sharp, double radius, double x, double y) {
  double lowest = 1e9;
  for (int j = 0; j < sharp.z_nm.height(); ++j)
    for (int i = 0; i < sharp.z_nm.width(); ++i) {
      const double dx = (i - sharp.apex_x) * sharp.pitch_x_nm - x,
                   dy = (j - sharp.apex_y) * sharp.pitch_y_nm - y;
      const double rest = radius * radius - dx * dx - dy * dy;
      if (rest >= 0) lowest = std::min(lowest, -sharp.z_nm(i, j) - std::sqrt(rest));
    }
  return lowest + radius;
}

}  // namespace

TEST(TipShapes, ParabolaHasItsRadius) {
  const Tip tip = parabolic_tip(8, wide);
  validate(tip);
  EXPECT_NEAR(z(tip, 3, 4), -25.0 / 16, 1e-12);
}

TEST(TipShapes, ConeIsASphereThatEndsWithoutAKink) {
  const double radius = 4, angle = 20 * degree, at = radius * std::cos(angle);
  const Tip fine = conical_tip(radius, angle, {1e-3, 1, 16001, 1});
  validate(fine);
  EXPECT_NEAR(z(fine, 2, 0), -(4 - std::sqrt(12.0)), 1e-9);
  EXPECT_NEAR(z(fine, at - 1e-3, 0) - z(fine, at, 0), 1e-3 / std::tan(angle), 1e-5);
  EXPECT_NEAR(z(fine, at, 0) - z(fine, at + 1e-3, 0), 1e-3 / std::tan(angle), 1e-5);
  EXPECT_NEAR(z(fine, 6, 0) - z(fine, 7, 0), 1 / std::tan(angle), 1e-9);
  EXPECT_NEAR(z(conical_tip(0, angle, wide), 3, 4), -5 / std::tan(angle), 1e-9);
}

TEST(TipShapes, BallHidesItsStemUnlessThatWidens) {
  const Tip ball = ball_tip(5, 2, 0, wide);
  validate(ball);
  EXPECT_NEAR(z(ball, 3, 0), -1, 1e-12);
  EXPECT_NEAR(z(ball, 5, 0), -5, 1e-12);
  EXPECT_EQ(z(ball, 5.5, 0), -std::numeric_limits<double>::infinity());
  const Tip flared = ball_tip(5, 3, 45 * degree, wide);
  EXPECT_NEAR(z(flared, 10, 0), -(9 + 7), 1e-12);
}

// Unequal faces: the sample must be where the *structuring function* has it, turned by 180 degrees.
TEST(TipShapes, PyramidFacesLieWhereTheyAreAsked) {
  const Tip tip = pyramidal_tip({{15 * degree, 25 * degree, 35 * degree, 25 * degree}, 0, 0}, wide);
  validate(tip);
  EXPECT_NEAR(z(tip, -6, 0), -6 / std::tan(15 * degree), 1e-9);
  EXPECT_NEAR(z(tip, 0, -6), -6 / std::tan(25 * degree), 1e-9);
  EXPECT_NEAR(z(tip, 6, 0), -6 / std::tan(35 * degree), 1e-9);
}

TEST(TipShapes, PyramidIsRoundedAsASphereRolls) {
  const PyramidShape shape{{40 * degree, 50 * degree, 30 * degree}, 0.3, 3};
  const Tip sharp = pyramidal_tip({shape.face_angles_rad, 0.3, 0}, {0.02, 0.02, 801, 801});
  const Tip tip = pyramidal_tip(shape, {1, 1, 11, 11});
  validate(tip);
  for (int y = -5; y <= 5; ++y)
    for (int x = -5; x <= 5; ++x)
      EXPECT_NEAR(-z(tip, x, y), rolled(sharp, 3, x, y), 3e-3) << x << ", " << y;
}

TEST(TipShapes, ManyFacesAreACone) {
  const Tip pyramid = pyramidal_tip({std::vector<double>(400, 30 * degree), 0, 2}, wide);
  const Tip cone = conical_tip(2, 30 * degree, wide);
  for (std::size_t i = 0; i < cone.z_nm.size(); ++i)
    EXPECT_NEAR(pyramid.z_nm.data()[i], cone.z_nm.data()[i], 2e-3);
}

TEST(TipShapes, HemisphereEndsAtItsRadius) {
  const Tip tip = hemisphere_tip(3, 1, 0.5, 100, 100);
  validate(tip);
  EXPECT_EQ(tip.z_nm.width(), 7);
  EXPECT_EQ(tip.z_nm.height(), 13);
  EXPECT_NEAR(z(tip, 3, 0), -3, 1e-12);
  EXPECT_EQ(z(tip, 3, 0.5), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(hemisphere_tip(1e9, 1, 1, 5, 3).z_nm.width(), 9);
  EXPECT_EQ(hemisphere_tip(0, 1, 1, 5, 3).z_nm.size(), 1u);
}

TEST(TipShapes, RefuseImpossibleOnes) {
  const TipSampling s;
  EXPECT_THROW(parabolic_tip(0, s), InvalidInput);
  EXPECT_THROW(parabolic_tip(std::nan(""), s), InvalidInput);
  EXPECT_THROW(parabolic_tip(1, {0, 1, 3, 3}), InvalidInput);
  EXPECT_THROW(parabolic_tip(1, {1, 1, 0, 3}), InvalidInput);
  EXPECT_THROW(conical_tip(-1, 0.3, s), InvalidInput);
  EXPECT_THROW(conical_tip(1, 1.6, s), InvalidInput);
  EXPECT_THROW(ball_tip(5, 5, 0, s), InvalidInput);
  EXPECT_THROW(ball_tip(5, 1, -0.1, s), InvalidInput);
  EXPECT_THROW(pyramidal_tip({{0.3, 0.3}, 0, 0}, s), InvalidInput);
  EXPECT_THROW(pyramidal_tip({{0.3, 0.3, 0}, 0, 0}, s), InvalidInput);
  EXPECT_THROW(hemisphere_tip(-1, 1, 1, 5, 5), InvalidInput);
}

}  // namespace surf
