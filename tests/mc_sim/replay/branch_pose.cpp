// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/branch_pose.h"

#include <gtest/gtest.h>

#include "random_direction.h"
#include "surf/core/random.h"

namespace surf::mc {
namespace {

std::uint64_t vertex(std::int16_t x, std::int16_t y, std::int16_t z) {
  return std::bit_cast<std::uint64_t>(PackedVertex{x, y, z, 77});
}
const std::uint64_t places[] = {vertex(0, 0, 0), vertex(100, -20, 7), vertex(-32000, 31000, 5),
                                vertex(1, 2, -3)};

FramedPlane some_plane() {
  FramedPlane plane;
  plane.normal = float4(normalized({0.2, -0.4, 0.9}));
  plane.point = float4({3, 1, -2});
  return plane;
}

BranchPose some_pose() {
  BranchPose pose;
  pose.origin = float4({5, -3, 1});
  pose.scaled = beam_frame(normalized({0.3, 0.5, -0.8}), 0.37);
  pose.scale(-9);
  pose.note_change();
  pose.measure_from(some_plane());
  return pose;
}

void expect_near(const Float4& a, const Float4& b, float tolerance = 2e-4f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

void expect_heights(const BranchPose& pose) {
  const FramedPlane plane = some_plane();
  for (const std::uint64_t at : places) {
    EXPECT_NEAR(pose.height_over_frame(at), pose.point(at)[2], 2e-4);
    EXPECT_NEAR(pose.height_over_plane(at), plane.along(pose.point(at) - plane.point), 2e-4);
  }
}

TEST(Coordinates, AreThoseOfThePackedVertex) {
  const Float4 v = coordinates(vertex(-32768, 32767, -5));
  EXPECT_EQ(v[0], -32768);
  EXPECT_EQ(v[1], 32767);
  EXPECT_EQ(v[2], -5);
}

TEST(BranchPose, KeepsHeightsOverThePlaneAndTheFrame) { expect_heights(some_pose()); }

TEST(BranchPose, AnotherUnitIsAnotherScaleOfTheSamePoints) {
  BranchPose pose = some_pose();
  const Float4 before = pose.point(vertex(8, 16, -24));
  pose.scale(-8);
  expect_near(pose.point(vertex(4, 8, -12)), before, 1e-6f);
  expect_heights(pose);
}

TEST(BranchPose, AMirrorTurnsHeightsOverThePlaneRoundAndIsItsOwnInverse) {
  const BranchPose before = some_pose();
  BranchPose pose = before;
  pose.mirror_in(some_plane());
  EXPECT_TRUE(pose.deflected);
  EXPECT_EQ(pose.moves, before.moves);
  EXPECT_EQ(pose.changes, before.changes + 1);
  for (const std::uint64_t at : places)
    EXPECT_NEAR(pose.height_over_plane(at), -before.height_over_plane(at), 2e-4);
  expect_heights(pose);
  pose.mirror_in(some_plane());
  for (const std::uint64_t at : places) expect_near(pose.point(at), before.point(at));
}

TEST(BranchPose, AMoveTakesOnePlaceToTheOtherAndKeepsDistances) {
  const BranchPose before = some_pose();
  BranchPose pose = before;
  const Float4 from = before.point(places[1]), to = float4({-7, 2, 4});
  pose.move(turn(normalized({1, 2, 3}), normalized({-2, 1, 1})), from, to);
  EXPECT_EQ(pose.moves, before.moves + 1);
  expect_near(pose.point(places[1]), to);
  for (const std::uint64_t at : places)
    EXPECT_NEAR(squared_length(pose.point(at) - to), squared_length(before.point(at) - from),
                1e-4f * (1 + squared_length(before.point(at) - from)));
  pose.measure_from(some_plane());
  expect_heights(pose);
}

TEST(BranchPose, AChildBeginsAtItsVertex) {
  const BranchPose pose = some_pose();
  const BranchPose child = pose.child_at(places[1]);
  expect_near(child.point(places[0]), pose.point(places[1]));
  EXPECT_NEAR(child.height_over_plane(places[0]), pose.height_over_plane(places[1]), 2e-4);
  EXPECT_NEAR(child.height_over_frame(places[0]), pose.height_over_frame(places[1]), 2e-4);
  expect_near(child.point(places[3]) - child.point(places[0]),
              pose.point(places[3]) - pose.point(places[0]));
}

TEST(BranchPose, ANewDirectionKeepsThePlaceAndItsHeight) {
  BranchPose pose = some_pose();
  pose.mirror_in(some_plane());
  const Float4 place = pose.point(places[1]);
  const float height = pose.height_over_plane(places[1]);
  const Rotation home = beam_frame({0, 0, -1}, 0.1);
  pose.resample_direction(home, places[1], some_plane());
  EXPECT_FALSE(pose.deflected);
  expect_near(pose.point(places[1]), place);
  EXPECT_FLOAT_EQ(pose.height_over_plane(places[1]), height);
  const Float4 way = pose.point(places[3]) - place;
  expect_near(way,
              home(coordinates(places[3]) - coordinates(places[1])) * power_of_two(pose.exponent));
  expect_heights(pose);
}

}  // namespace
}  // namespace surf::mc
