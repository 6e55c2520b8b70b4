// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/packed_heights.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "random_direction.h"
#include "replay/branch_pose.h"
#include "surf/core/random.h"

namespace surf::mc {
namespace {

std::uint64_t random_word(RandomStream& random) {
  const auto coordinate = [&] {
    return static_cast<std::int16_t>(std::lround((2 * random.uniform() - 1) * 32767));
  };
  const double radius = 65535 * random.uniform() * random.uniform() * random.uniform();
  return std::bit_cast<std::uint64_t>(
      PackedSphere{coordinate(), coordinate(), coordinate(), static_cast<std::uint16_t>(radius)});
}

// A plane and a branch of this unit, and the plane's heights as `BranchPose` and as PackedHeights
// have them.
struct Case {
  BranchPose pose;
  Float4 over;

  Case(RandomStream& random, int exponent, double apart) {
    pose.exponent = exponent;
    const Vec3 z = test::isotropic(random), n = test::isotropic(random);
    const Frame frame = frame_about({}, z);
    pose.scaled =
        Rotation{float4(frame.x), float4(frame.y), float4(frame.z)} * power_of_two(exponent);
    const auto along = [&](const Float4& v) { return static_cast<float>(dot(n, vec3(v))); };
    over = Float4{along(pose.scaled.x), along(pose.scaled.y), along(pose.scaled.z),
                  static_cast<float>((2 * random.uniform() - 1) * apart)};
    pose.over_plane = over;
  }
  /// Moves the plane to within a few units of a point: rounding decides on which side that is.
  void move_near(std::uint64_t point, RandomStream& random) {
    over[3] +=
        static_cast<float>(6 * (2 * random.uniform() - 1) * unit()) - pose.height_over_plane(point);
    pose.over_plane = over;
  }
  double unit() const { return power_of_two(pose.exponent); }
};

// Few and many units away from the plane, and so far that heights no longer fit.
constexpr std::array far_in_units{100.0, 1e4, 5e4, 1e6, 1e9};

// Units, distances and points of every kind; every other plane passes near one of the points.
template <std::size_t N>
Case random_case(RandomStream& random, int round, std::array<std::uint64_t, N>& words) {
  const int exponent = -12 + round % 8;
  Case c(random, exponent,
         far_in_units[static_cast<std::size_t>(round) % 5] * power_of_two(exponent));
  for (std::uint64_t& w : words) w = random_word(random);
  if (round % 2) c.move_near(words[static_cast<std::size_t>(round) % N], random);
  return c;
}

TEST(PackedHeights, AskForACloserLookWhereverAPointMayBeAbove) {
  RandomStream random(1, 0, 0);
  int above = 0, asked = 0, all = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<std::uint64_t, 9> words;
    const Case c = random_case(random, round, words);
    const PackedHeights heights(c.over, c.pose.exponent);
    for (int count = 1; count <= 9; ++count) {
      const unsigned bits = heights.may_be_above(words.data(), count);
      EXPECT_EQ(bits >> count, 0u);
      for (int i = 0; i < count; ++i) {
        const float height = c.pose.height_over_plane(words[static_cast<std::size_t>(i)]);
        ++all;
        above += height > 0;
        asked += bits >> i & 1;
        EXPECT_TRUE(!(height > 0) || (bits >> i & 1)) << height;
        EXPECT_TRUE(height > -9 * c.unit() || !(bits >> i & 1) ||
                    std::fabs(c.over[3]) > 5e4 * c.unit());
      }
    }
  }
  EXPECT_GT(above, all / 4);
  EXPECT_LT(asked, above + all / 20);
}

TEST(PackedHeights, TellTheSideOnlyWhereItIsCertain) {
  RandomStream random(2, 0, 0);
  int told = 0, all = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<std::uint64_t, 9> words;
    const Case c = random_case(random, round, words);
    const PackedHeights heights(c.over, c.pose.exponent);
    for (const float by : {0.0f, 0.002f, 1.0f}) {
      const auto [higher, lower] = heights.sides(words.data(), 9, by);
      EXPECT_EQ(higher & lower, 0u);
      for (std::size_t i = 0; i < 9; ++i) {
        const float height = c.pose.height_over_plane(words[i]);
        ++all;
        told += (higher | lower) >> i & 1;
        EXPECT_TRUE(!(higher >> i & 1) || height > by);
        EXPECT_TRUE(!(lower >> i & 1) || height < -by);
      }
    }
  }
  EXPECT_GT(told, all / 2);
}

TEST(PackedHeights, ClearSpheresAreFartherThanTheirRadii) {
  RandomStream random(3, 0, 0);
  int clear = 0, missed = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<std::uint64_t, 8> spheres;
    const Case c = random_case(random, round, spheres);
    const PackedHeights heights(c.over, c.pose.exponent);
    for (int count = 1; count <= 8; ++count) {
      const unsigned bits = heights.clear(spheres.data(), count, 0.002f);
      EXPECT_EQ(bits >> count, 0u);
      for (int i = 0; i < count; ++i) {
        const std::uint64_t s = spheres[static_cast<std::size_t>(i)];
        const double room = std::fabs(c.pose.height_over_plane(s)) - c.pose.radius(s);
        EXPECT_TRUE(!(bits >> i & 1) || room > 0.002);
        clear += bits >> i & 1;
        missed += !(bits >> i & 1) && room > 0.002 + 9 * c.unit() &&
                  std::fabs(c.over[3]) < 5e4 * c.unit();
      }
    }
  }
  EXPECT_GT(clear, 40000);
  EXPECT_EQ(missed, 0);
}

}  // namespace
}  // namespace surf::mc
