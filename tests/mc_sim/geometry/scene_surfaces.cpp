// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/scene_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/embree_scene.h"
#include "random_direction.h"
#include "specimens.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mc/geometry/scene.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {
namespace {

Specimen mesa() {
  Specimen s = test::flat("Si");
  s.substrate.reset();
  s.height_field = HeightFieldBody{"mesa", make_mesa({150, 150, 2}, 60, 40, 20), 0, Edge::flat};
  return s;
}

SceneSurfaces surfaces_of(const Specimen& s, const Scan& scan) {
  return make_surfaces(s, validate(s), {}, scan, {});
}

bool accept_all(void*, std::uint32_t, double, double) { return true; }

TEST(SceneSurfaces, MergedPlanesAreHitWhereTheirTrianglesWere) {
  const Specimen s = mesa();
  const Scan scan = test::square_scan(100, 4);
  const SceneSurfaces surfaces = surfaces_of(s, scan);
  const TriangleMesh whole = half_space_top(s.height_field->field, 10);
  EXPECT_LT(surfaces.mesh.triangles.values.size(), whole.triangles.size() / 4);
  const EmbreeScene before(whole);
  const Scene after(surfaces, s.materials, {}, scan);
  RandomStream random(1, 0, 0);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 start{140 * random.uniform() - 70, 140 * random.uniform() - 70,
                     61 + 20 * random.uniform()};
    Vec3 down = test::isotropic(random);
    down.z = -std::fabs(down.z);
    Vec3 hit;
    EmbreeScene::Hit expected;
    const bool met = before.nearest(start, down, 1e4, accept_all, nullptr, expected);
    if (!met || std::max(std::fabs(expected.position.x), std::fabs(expected.position.y)) > 74)
      continue;
    ++hits;
    ASSERT_TRUE(after.first_surface(start, down, hit));
    EXPECT_LT(length(hit - expected.position), 1e-9);
  }
  EXPECT_GT(hits, 5000);
}

TEST(SceneSurfaces, GiveTheSceneThatTheirSpecimenGives) {
  Specimen s = test::flat("Si");
  s.materials.push_back(test::flat("Au").materials[0]);
  s.bodies.push_back({"ball", make_sphere({0, 0, 15}, 20, 3), 1});
  s.bodies.push_back({"box", make_box({-40, -40, -5}, {-10, -10, 12}, 5), 0});
  const Scan scan = test::square_scan(100, 6);
  const Scene one(s, {}, scan);
  const Scene other(surfaces_of(s, scan), s.materials, {}, scan);
  EXPECT_EQ(one.summary().triangles, other.summary().triangles);
  EXPECT_EQ(one.summary().triangles_left_out, other.summary().triangles_left_out);
  EXPECT_EQ(one.summary().shells, other.summary().shells);
  SimulationOptions options;
  options.budget = ElectronsPerPixel{20};
  options.method = Method::direct;
  const Image a = make_image(simulate(one, options), scan),
              b = make_image(simulate(other, options), scan);
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    EXPECT_EQ(a.channels[c].values, b.channels[c].values);
}

TEST(SceneSurfaces, ABareSubstrateHasNoTriangles) {
  const SceneSurfaces surfaces = surfaces_of(test::flat("Si"), test::square_scan(100, 4));
  EXPECT_TRUE(surfaces.mesh.empty());
  EXPECT_TRUE(surfaces.half_space);
  EXPECT_EQ(surfaces.plane_nm, 0.0);
  EXPECT_EQ(surfaces.shells.size(), 1u);
}

TEST(SceneSurfaces, AreInterrupted) {
  CancelToken cancel;
  cancel.cancel();
  const Specimen s = mesa();
  EXPECT_THROW(
      make_surfaces(s, validate(s), {}, test::square_scan(100, 4), {}, {.watch = {{}, &cancel}}),
      Interrupted);
}

}  // namespace
}  // namespace surf::mc
