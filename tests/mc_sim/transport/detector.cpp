// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surf/core/error.h"

namespace surf::mc {

namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    parse_detectors(text, "--detector");
  } catch (const UsageError& e) {
    return e.what();
  }
  return "no error";
}

Detector one(const std::string& text) { return parse_detectors(text, "--detector").at(0); }

}  // namespace

TEST(Detector, KnowsTheUsualOnes) {
  EXPECT_EQ(one("SE1").origin, Origin::se1);
  EXPECT_EQ(one("SE2").max_energy_ev, 50);
  EXPECT_EQ(one("annular").min_angle_deg, 15);
  EXPECT_EQ(one("in-lens").max_angle_deg, 45);
  EXPECT_EQ(one("side").axis->polar_deg, 60);
  const auto quadrants = parse_detectors("quadrants", "--detector");
  ASSERT_EQ(quadrants.size(), 4u);
  EXPECT_EQ(quadrants[0].name, "BSE-right");
  EXPECT_EQ(quadrants[0].from_azimuth_deg, 315);
  EXPECT_EQ(quadrants[3].to_azimuth_deg, 315);
}

TEST(Detector, TakesChangesAndOnesOfOnesOwn) {
  const Detector loss = one("loss:energy=0.9keV..1keV,cone=30deg");
  EXPECT_EQ(loss.name, "loss");
  EXPECT_EQ(loss.min_energy_ev, 900);
  EXPECT_EQ(loss.max_energy_ev, 1000);
  EXPECT_EQ(loss.min_angle_deg, 0);
  EXPECT_EQ(loss.max_angle_deg, 30);
  EXPECT_FALSE(loss.axis);
  const Detector side = one("side:name=ET,axis=70deg/90deg,efficiency=80%,energy=..30eV");
  EXPECT_EQ(side.name, "ET");
  EXPECT_EQ(side.axis->polar_deg, 70);
  EXPECT_EQ(side.axis->azimuth_deg, 90);
  EXPECT_EQ(side.efficiency, 0.8);
  EXPECT_EQ(side.max_energy_ev, 30);
  EXPECT_EQ(one("below:side=down,energy=50eV..").side, Side::down);
  EXPECT_EQ(one("q:sector=315deg..45deg").from_azimuth_deg, 315);
}

TEST(Detector, IsReadBackAsItIsWritten) {
  for (const char* text : {"SE1", "SE2", "quadrants", "annular", "in-lens", "side",
                           "x:energy=10eV..20eV,cone=10..20,sector=1..2,efficiency=0.5,side=up"})
    for (const Detector& d : parse_detectors(text, "test")) {
      const std::string written = format_detector(d);
      EXPECT_EQ(format_detector(one(written)), written);
    }
}

TEST(Detector, SaysWhetherItLooksFromASide) {
  for (const char* side : {"side", "x:sector=0..180", "x:axis=30deg/90deg"})
    EXPECT_TRUE(looks_from_a_side(one(side))) << side;
  for (const Detector& quadrant : parse_detectors("quadrants", "--detector"))
    EXPECT_TRUE(looks_from_a_side(quadrant)) << quadrant.name;
  for (const char* round : {"SE", "BSE", "SE1", "annular", "in-lens", "x:axis=beam", "x:side=down"})
    EXPECT_FALSE(looks_from_a_side(one(round))) << round;
}

TEST(Detector, SaysWhatIsWrong) {
  EXPECT_THAT(error_of("ringed"), HasSubstr("there is no detector 'ringed'"));
  EXPECT_THAT(error_of("ringed"), HasSubstr("quadrants"));
  EXPECT_THAT(error_of("x:colour=red"), HasSubstr("there is no 'colour'"));
  EXPECT_THAT(error_of("x:energy=5"), HasSubstr("no range"));
  EXPECT_THAT(error_of("x:energy=50..5"), HasSubstr("energy window is empty"));
  EXPECT_THAT(error_of("x:cone=20..200"), HasSubstr("beyond 180"));
  EXPECT_THAT(error_of("x:sector=10..10"), HasSubstr("sector is empty"));
  EXPECT_THAT(error_of("x:efficiency=0"), HasSubstr("outside 0 to 1"));
  EXPECT_THAT(error_of("x:efficiency=120%"), HasSubstr("outside 0 to 1"));
  EXPECT_THAT(error_of("x:side=left"), HasSubstr("any, up, down"));
  EXPECT_THAT(error_of("x:axis=200deg"), HasSubstr("axis"));
  EXPECT_THAT(error_of("quadrants:name=Q"), HasSubstr("names of their own"));
  EXPECT_THAT(error_of("a b:cone=3"), HasSubstr("no name for a channel"));
  EXPECT_THROW(validate({one("SE1"), one("SE1")}), UsageError);
}

}  // namespace surf::mc
