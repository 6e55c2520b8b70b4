// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/rotation.h"

#include <gtest/gtest.h>

#include "random_direction.h"
#include "surf/core/random.h"

namespace surf::mc {

namespace {

using test::isotropic;

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE(length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

void expect_at_right_angles(const Vec3& x, const Vec3& y, const Vec3& z, double tolerance) {
  for (const Vec3& a : {x, y, z}) EXPECT_NEAR(dot(a, a), 1, tolerance);
  for (const double d : {dot(x, y), dot(y, z), dot(z, x)}) EXPECT_NEAR(d, 0, tolerance);
}

Rotation any_rotation(RandomStream& random) {
  return beam_frame(isotropic(random), 2 * random.uniform()) * turn(isotropic(random), {0, 0, 1});
}

constexpr double single = 1e-6, twice = 1e-14;  // rounding

}  // namespace

TEST(Frame, StandsOnItsZ) {
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    // Along the axes, too, where what is aside of z could vanish.
    Vec3 z = isotropic(random);
    if (i < 6)
      z = {i / 2 == 0 ? 1 - 2.0 * (i % 2) : 0, i / 2 == 1 ? 1 - 2.0 * (i % 2) : 0,
           i / 2 == 2 ? 1 - 2.0 * (i % 2) : 0};
    const Frame f = frame_about({1, 2, 3}, z);
    EXPECT_EQ(f.z, z);
    EXPECT_EQ(f.origin, (Vec3{1, 2, 3}));
    expect_at_right_angles(f.x, f.y, f.z, twice);
    expect_near(cross(f.x, f.y), f.z, twice);  // right-handed
  }
}

TEST(Frame, InAndOutUndoEachOther) {
  RandomStream random(2, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin = isotropic(random) * 1e6;
    const Frame f = frame_about(origin, isotropic(random));
    const Vec3 p = isotropic(random) * 100;
    expect_near(f.in(f.out(p)), p, 1e-9);
    expect_near(f.out(f.in(origin + p)), origin + p, 1e-9);
    expect_near(f.direction_in(f.direction_out(p)), p, 100 * twice);
    expect_near(f.in(origin), {}, 0);
    expect_near(f.in(origin + f.z * 7), {0, 0, 7}, 1e-9);
    expect_near(f.direction_in(f.x), {1, 0, 0}, twice);
  }
}

TEST(Frame, HasRotationsInItsOwnAxes) {
  RandomStream random(3, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Frame f = frame_about({}, isotropic(random));
    const Rotation r = any_rotation(random);
    const Float4 v = float4(isotropic(random));
    expect_near(vec3(rotation_in(f, r)(v)), f.direction_in(vec3(r(v))), single);
  }
}

TEST(Rotation, TurnTakesOneDirectionToAnother) {
  RandomStream random(4, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from = isotropic(random), to = i % 5 == 0 ? from : isotropic(random);
    const Rotation r = turn(from, to);
    expect_near(vec3(r(float4(from))), to, single);
    expect_near(vec3(turn(to, from)(r(float4(from)))), from, single);
    expect_at_right_angles(vec3(r.x), vec3(r.y), vec3(r.z), single);
  }
}

TEST(Rotation, MirrorTurnsItsNormalRound) {
  RandomStream random(5, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 n = isotropic(random), v = isotropic(random);
    const Rotation m = mirror(n);
    expect_near(vec3(m(float4(n))), -n, single);
    expect_near(vec3(m(m(float4(v)))), v, single);
    expect_near(vec3((m * m)(float4(v))), v, single);
  }
}

TEST(Rotation, BeamFrameTakesDownToItsDirection) {
  RandomStream random(6, 0, 0);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 to = i == 0 ? Vec3{0, 0, 1} : i == 1 ? Vec3{0, 0, -1} : isotropic(random);
    const Rotation r = beam_frame(to, 2 * random.uniform());
    expect_near(vec3(r(Float4{0, 0, -1, 0})), to, single);
    expect_at_right_angles(vec3(r.x), vec3(r.y), vec3(r.z), single);
  }
}

}  // namespace surf::mc
