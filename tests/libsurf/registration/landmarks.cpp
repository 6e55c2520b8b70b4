// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/registration/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "surf/core/error.h"

namespace surf {
namespace {

using testing::HasSubstr;

constexpr Affine map{0.9, -0.2, 1e4, 0.3, 1.1, -2e4};

std::vector<LandmarkPair> pairs_at(const std::vector<Point2>& places) {
  std::vector<LandmarkPair> pairs;
  for (const Point2 p : places) pairs.push_back({p, map(p)});
  return pairs;
}

std::string failure(const std::vector<LandmarkPair>& pairs) {
  try {
    fit_landmarks(pairs);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Landmarks, ThreeGiveTheMapFarFromTheOriginToo) {
  const LandmarkFit fit =
      fit_landmarks(pairs_at({{1e6, 1e6}, {1e6 + 500, 1e6}, {1e6 + 100, 1e6 + 300}}));
  EXPECT_NEAR(fit.sem_to_afm.xx, map.xx, 1e-10);
  EXPECT_NEAR(fit.sem_to_afm.xy, map.xy, 1e-10);
  EXPECT_NEAR(fit.sem_to_afm.yx, map.yx, 1e-10);
  EXPECT_NEAR(fit.sem_to_afm.yy, map.yy, 1e-10);
  EXPECT_NEAR(fit.sem_to_afm({1e6, 1e6}).x, map({1e6, 1e6}).x, 1e-6);
  EXPECT_EQ(fit.rms_nm, 0);
}

TEST(Landmarks, MoreAreFittedByLeastSquares) {
  // The fourth corner of a square is off by 4: each takes a quarter of it, alternately.
  std::vector<LandmarkPair> pairs = pairs_at({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  pairs[3].afm_nm.x += 4;
  const LandmarkFit fit = fit_landmarks(pairs);
  for (const double residual : fit.residuals_nm) EXPECT_NEAR(residual, 1, 1e-9);
  EXPECT_NEAR(fit.rms_nm, 1, 1e-9);
}

TEST(Landmarks, SaysWhichDoNotDetermineIt) {
  EXPECT_THAT(failure(pairs_at({{0, 0}, {1, 2}})), HasSubstr("there are 2 pairs"));
  EXPECT_THAT(failure(pairs_at({{0, 0}, {1, 2}, {2, 4}, {3, 6}})),
              HasSubstr("pairs 1, 2, 3 and 4 all lie on a line in the SEM"));
  EXPECT_THAT(failure(pairs_at({{0, 0}, {5, 1}, {0, 0}})),
              HasSubstr("pairs 1 and 3 lie at one place in the SEM"));
  EXPECT_THAT(failure(pairs_at({{7, 7}, {7, 7}, {7, 7}})), HasSubstr("lie at one place"));
  std::vector<LandmarkPair> flat = pairs_at({{0, 0}, {10, 0}, {0, 10}});
  for (LandmarkPair& pair : flat) pair.afm_nm.y = 3;
  EXPECT_THAT(failure(flat), HasSubstr("AFM"));
  flat[1].afm_nm.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(failure(flat), HasSubstr("pair 2 is not finite"));
}

TEST(Landmarks, OneLineIsJudgedWithoutASenseOfScale) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    EXPECT_NO_THROW(fit_landmarks(pairs_at({{0, 0}, {scale, 0}, {0.5 * scale, 0.01 * scale}})));
    EXPECT_THROW(fit_landmarks(pairs_at({{0, 0}, {scale, 0}, {0.5 * scale, 1e-6 * scale}})),
                 InvalidInput);
  }
}

}  // namespace
}  // namespace surf
