// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_doubt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace surf::workflow {
namespace {

/// A registration whose place is known to `slide_nm` along the scan's x and to `held_nm` along its
/// y; the SEM image has pixels of 4 by 2 nm.
struct Sliding {
  Pose pose;
  PlacedImage sem;

  Sliding(double slide_nm, double held_nm) {
    pose.registration.emplace();
    Registration& r = *pose.registration;
    r.verdict = RegistrationVerdict::ambiguous;
    r.stderr_px = 3;
    r.slides = true;
    r.covariance[6 * 2 + 2] = slide_nm * slide_nm;
    r.covariance[6 * 5 + 5] = held_nm * held_nm;
    pose.places = {{Affine{}, 0, 0.99, true}, {Affine{}, 5, 0.01, true}};
    sem.values = Grid<double>(40, 30);
    sem.pitch_x_nm = 4, sem.pitch_y_nm = 2;
  }
};

TEST(PlaceDoubt, IsATenthOfTheImageAlongWhatSlides) {
  const Sliding s(12, 1);
  EXPECT_TRUE(s.pose.preferred());
  EXPECT_FALSE(s.pose.verified());  // places between those that were judged are as likely
  const PlaceDoubt doubt = place_doubt(s.pose, s.sem);
  EXPECT_NEAR(doubt.along_x, 16, 1e-12);
  EXPECT_NEAR(doubt.along_y, 16 * 0.25 / 9, 1e-12);
  EXPECT_NEAR(doubt.both, 0, 1e-12);
  EXPECT_NEAR(largest_px(doubt), 4, 1e-12);
}

TEST(PlaceDoubt, TurnsWithTheMap) {
  Sliding s(12, 0);
  AffineParts turned;
  turned.rotation_rad = std::numbers::pi / 2;  // the scan's x is the SEM's y
  s.pose.sem_to_afm = make_affine(turned);
  const PlaceDoubt doubt = place_doubt(s.pose, s.sem);
  EXPECT_NEAR(doubt.along_x, 0, 1e-12);
  EXPECT_NEAR(doubt.along_y, 16, 1e-12);
  turned.rotation_rad = std::numbers::pi / 4;
  s.pose.sem_to_afm = make_affine(turned);
  s.sem.pitch_y_nm = 4;
  const PlaceDoubt oblique = place_doubt(s.pose, s.sem);
  EXPECT_NEAR(oblique.along_x, 8, 1e-12);
  EXPECT_NEAR(oblique.both, -8, 1e-12);
  EXPECT_NEAR(largest_px(oblique), 4, 1e-12);
}

TEST(PlaceDoubt, IsInAllDirectionsWhereNoPlaceIsPreferredAndNoneWhereItIsVerified) {
  Sliding s(12, 0);
  s.pose.registration->slides = false;
  EXPECT_TRUE(s.pose.verified());
  EXPECT_EQ(largest_px(place_doubt(s.pose, s.sem)), 0);
  s.pose.places.clear();
  EXPECT_FALSE(s.pose.verified());
  EXPECT_EQ(place_doubt(s.pose, s.sem).along_x, 9);
  EXPECT_EQ(place_doubt(s.pose, s.sem).along_y, 9);
  s.pose.registration->slides = true;
  EXPECT_NEAR(place_doubt(s.pose, s.sem).along_x, 25, 1e-12);
}

TEST(PlaceDoubt, IsTowardsRivalsThatWereNotJudged) {
  Sliding s(12, 0);
  s.pose.registration->slides = false;
  for (const double y_nm : {2.0, -4.0, 0.0, 6.0}) {
    Affine rival;
    rival.y0 = y_nm;
    s.pose.registration->rivals.push_back({rival, 0.9, std::abs(y_nm) / 2});
  }
  EXPECT_TRUE(s.pose.verified());
  EXPECT_EQ(largest_px(place_doubt(s.pose, s.sem)), 0);
  s.pose.every_rival_judged = false;
  EXPECT_FALSE(s.pose.verified());
  EXPECT_EQ(place_doubt(s.pose, s.sem).along_x, 0);
  EXPECT_NEAR(place_doubt(s.pose, s.sem).along_y, (1 + 4 + 9) / 4.0, 1e-12);
  s.pose.registration->sem_to_afm.x0 = 8;  // a rival was preferred
  EXPECT_NEAR(place_doubt(s.pose, s.sem).along_x, 4 / 4.0, 1e-12);
  s.pose.registration->rivals.back().sem_to_afm.y0 = 1000;  // farther than is believed
  EXPECT_NEAR(largest_px(place_doubt(s.pose, s.sem)), 4, 1e-12);
}

TEST(PlaceDoubt, StaysFinite) {
  Sliding s(1e9, 1);
  EXPECT_NEAR(place_doubt(s.pose, s.sem).along_x, 16, 1e-9);
  s.pose.registration->covariance[6 * 2 + 2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(place_doubt(s.pose, s.sem).along_x, 16);
  s.pose.registration->slides = false;
  s.pose.places.clear();
  s.pose.registration->stderr_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(place_doubt(s.pose, s.sem).along_x, 1e4);
}

}  // namespace
}  // namespace surf::workflow
