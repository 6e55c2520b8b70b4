// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/surface_query.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "geometry/scene_impl.h"
#include "random_direction.h"
#include "specimens.h"
#include "surf/core/random.h"
#include "surf/core/triangle_geometry.h"
#include "surf/mesh/height_field_mesh.h"

namespace surf::mc {
namespace {

/// Beside a bump of a rough surface, with the patch there or without.
class SurfaceQueries : public testing::TestWithParam<bool> {
 protected:
  SurfaceQueries()
      : scene_(specimen(), {}, test::square_scan(40, 4)), geometry_(scene_.impl()),
        query_(geometry_) {
    SceneGeometry::Surface met;
    SceneGeometry::State state = 0;
    if (geometry_.crossing({1.3, -2.1, 100}, {0, 0, -1}, HUGE_VAL, state, met) != Crossing::surface)
      throw std::logic_error("nothing there");
    inside_ = met.state_ahead;
    point_ = met.position;
    patch_.emplace(*scene_.impl().triangles, scene_.impl().plane_nm, point_, met.normal);
    query_.at({point_, met.normal, 0, false, inside_, 0}, GetParam() ? &*patch_ : nullptr);
    query_.enter(point_);
  }

  static Specimen specimen() {
    Specimen s = test::flat("Si");
    s.substrate.reset();
    s.height_field = HeightFieldBody{"rough", make_rough({60, 60, 1}, 3, 8, 7), 0, Edge::mirror};
    return s;
  }

  double distance(const Vec3& p) const {
    double least = HUGE_VAL;
    const MeshView& mesh = scene_.impl().triangles->mesh();
    for (const Triangle& t : mesh.triangles) {
      const Vec3 v[3] = {mesh.vertices_nm[t[0]] - p, mesh.vertices_nm[t[1]] - p,
                         mesh.vertices_nm[t[2]] - p};
      least = std::min(least, length(closest_point(v[0], v[1], v[2], {})));
    }
    return least;
  }

  Vec3 somewhere(RandomStream& random) const {
    return point_ + test::isotropic(random) * (12 * random.uniform());
  }

  /// Inside, not far below the surface.
  Vec3 below(RandomStream& random, double depth_nm = 6) {
    const Vec3 place = somewhere(random);
    SceneGeometry::Surface met;
    SceneGeometry::State state = 0;
    EXPECT_EQ(geometry_.crossing({place.x, place.y, 100}, {0, 0, -1}, HUGE_VAL, state, met),
              Crossing::surface);
    return met.position - Vec3{0, 0, 0.01 + depth_nm * random.uniform()};
  }

  Scene scene_;
  SceneGeometry geometry_;
  SurfaceQuery<SceneGeometry> query_;
  SceneGeometry::State inside_ = 0;
  Vec3 point_;
  std::optional<LocalSurface> patch_;
};

TEST_P(SurfaceQueries, ASphereThatMissesIsFartherThanItsRadius) {
  RandomStream random(3, 1, GetParam());
  int missed = 0;
  for (int i = 0; i < 1000; ++i) {
    BranchPose pose;
    pose.origin = float4(query_.frame().in(somewhere(random)));
    pose.exponent = -8;
    pose.scaled = Rotation{} * power_of_two(pose.exponent);
    pose.note_change();
    const auto radius = static_cast<std::uint64_t>(1 + random.uniform() * 800);  // of 2^-8 nm
    Near near;
    if (!query_.misses(pose, inside_, radius << 48, near)) continue;
    ++missed;
    EXPECT_GT(distance(query_.frame().out(vec3(pose.origin))), double(radius) / 256 - 1e-4);
  }
  EXPECT_GT(missed, 100);
}

TEST_P(SurfaceQueries, AClearWayMeetsNothing) {
  RandomStream random(4, 1, GetParam());
  int clear = 0, met = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from = below(random), direction = test::isotropic(random);
    const double whole = 3 * random.uniform();
    const Float4 start = float4(query_.frame().in(from)),
                 way = float4(query_.frame().direction_in(direction) * whole);
    if (query_.is_clear(start, way)) {
      ++clear;
      for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0})
        EXPECT_GT(distance(from + direction * (t * whole)), 0);
    }
    // The same first surface as without patch.
    SceneGeometry::State a = inside_, b = inside_;
    SceneGeometry::Surface one, other;
    std::int64_t rays = 0;
    const Crossing found = query_.first_crossing(from, direction, whole, a, one, false, rays);
    const Crossing traced = geometry_.crossing(from, direction, whole, b, other);
    ASSERT_EQ(found, traced);
    if (found != Crossing::surface) continue;
    ++met;
    EXPECT_NEAR(one.distance, other.distance, 1e-6);
  }
  EXPECT_GT(clear, 100);
  EXPECT_GT(met, 15);
}

// A node that lies anywhere near the surface: what is left out of it has to be clear of every
// triangle.
TEST_P(SurfaceQueries, WhatIsLeftOutOfANodeMeetsNothing) {
  RandomStream random(5, 1, GetParam());
  int out = 0, known = 0, spheres_out = 0;
  for (int round = 0; round < 3000; ++round) {
    BranchPose pose;
    pose.exponent = -12;
    const Frame turned = frame_about({}, test::isotropic(random));
    pose.scaled = Rotation{float4(turned.x), float4(turned.y), float4(turned.z)} *
                  power_of_two(pose.exponent);
    pose.origin = float4(query_.frame().in(below(random, 0.5)));
    pose.note_change();
    // A walk of eight steps within the ball that stands for the node.
    const double size = 0.05 + 0.5 * random.uniform();
    std::array<std::uint64_t, 9> points;
    for (std::uint64_t& p : points) {
      const Vec3 v = test::isotropic(random) *
                     (size * std::cbrt(random.uniform()) / power_of_two(pose.exponent));
      p = std::bit_cast<std::uint64_t>(
          PackedSphere{static_cast<std::int16_t>(v.x), static_cast<std::int16_t>(v.y),
                       static_cast<std::int16_t>(v.z), static_cast<std::uint16_t>(200)});
    }
    const auto ball =
        static_cast<std::uint64_t>(std::ceil(size / power_of_two(pose.exponent))) + 201;
    Near near;
    if (query_.misses(pose, inside_, ball << 48, near)) continue;
    const unsigned may = query_.may_meet(pose, points.data(), 8, near);
    known += near.faces.is_known;
    for (std::size_t i = 0; i < 8; ++i) {
      if (may >> i & 1) continue;
      ++out;
      const Vec3 from = query_.frame().out(vec3(pose.point(points[i]))),
                 to = query_.frame().out(vec3(pose.point(points[i + 1])));
      SceneGeometry::State state = inside_;
      SceneGeometry::Surface met;
      EXPECT_EQ(geometry_.crossing(from, normalized(to - from), length(to - from), state, met),
                Crossing::none);
    }
    const unsigned clear = query_.clear_of(pose, points.data(), 8, near);
    for (std::size_t i = 0; i < 8; ++i) {
      if (!(clear >> i & 1)) continue;
      ++spheres_out;
      EXPECT_GT(distance(query_.frame().out(vec3(pose.point(points[i])))), pose.radius(points[i]));
    }
  }
  EXPECT_EQ(known > 200, GetParam());
  EXPECT_EQ(out > 1000, GetParam());
  EXPECT_EQ(spheres_out > 1000, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Beside, SurfaceQueries, testing::Bool(), [](const auto& about) {
  return about.param ? "WithPatch" : "WithoutPatch";
});

}  // namespace
}  // namespace surf::mc
