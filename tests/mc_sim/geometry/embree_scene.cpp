// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/embree_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "geometry/triangle_shape.h"
#include "random_direction.h"
#include "surf/core/random.h"
#include "surf/core/triangle_geometry.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

using test::isotropic;

bool ahead(void*, std::uint32_t, double, double distance) { return distance >= 0; }
bool inward(void*, std::uint32_t, double cosine, double distance) {
  return cosine < 0 && distance >= 0;
}
bool outward(void*, std::uint32_t, double cosine, double distance) {
  return cosine > 0 && distance >= 0;
}

std::vector<std::uint32_t> all(const MeshView& mesh) {
  std::vector<std::uint32_t> out(mesh.triangles.size());
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

struct Corners {
  Vec3 v[3];
  Corners(const MeshView& mesh, std::uint32_t t)
      : v{mesh.vertices_nm[mesh.triangles[t][0]], mesh.vertices_nm[mesh.triangles[t][1]],
          mesh.vertices_nm[mesh.triangles[t][2]]} {}
  Vec3 middle() const { return (v[0] + v[1] + v[2]) * (1.0 / 3); }
};

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  transform(mesh, 1, by);
  return mesh;
}

// Closed, convex, with its middle at `center`: a way to there goes in once.
struct Body {
  const char* name;
  TriangleMesh mesh;
  Vec3 center;
};

std::vector<Body> bodies() {
  return {{"ball", make_sphere({0, 0, 0}, 10, 2), {0, 0, 0}},
          {"ball far away", make_sphere({1e6, -1e6, 1e6}, 10, 2), {1e6, -1e6, 1e6}},
          {"box", make_box({-8, -8, -8}, {8, 8, 8}, 4), {0, 0, 0}}};
}

// Exactly one way in from outside to the middle, and one out on the other side, near where it is
// said.
void expect_in_and_out(const EmbreeScene& scene, const std::vector<std::uint32_t>& faces,
                       const Vec3& from, const Vec3& through, const Vec3& to) {
  const Vec3 direction = normalized(to - from);
  EmbreeScene::Hit hit;
  ASSERT_TRUE(scene.nearest_of(faces, from, direction, length(to - from), inward, nullptr, hit))
      << "slipped in from " << from.x << " " << from.y << " " << from.z;
  ASSERT_LT(length(hit.position - through), 1e-6);
  ASSERT_NEAR(hit.distance, length(through - from), 1e-6);
  ASSERT_TRUE(scene.nearest_of(faces, to, -direction, length(to - from), outward, nullptr, hit))
      << "slipped out to " << from.x << " " << from.y << " " << from.z;
  ASSERT_LT(length(hit.position - through), 1e-6);
}

}  // namespace

TEST(EmbreeScene, FindsTheSameAmongKnownTrianglesAsAmongAll) {
  for (const TriangleMesh& mesh :
       {height_field_sheet(make_rough({40, 40, 1}, 3, 5, 1)), make_box({-9, -9, -9}, {9, 9, 9}, 3),
        moved(height_field_sheet(make_rough({40, 40, 1}, 3, 5, 1)), {1e6, 1e6, -1e6})}) {
    const EmbreeScene scene(mesh);
    const std::vector<std::uint32_t> faces = all(mesh);
    RandomStream random(1, mesh.triangles.size(), 0);
    int found = 0, missed = 0, nearby = 0;
    for (int i = 0; i < 5000; ++i) {
      const auto t = static_cast<std::uint32_t>(random.uniform() * double(faces.size()));
      const Vec3 start = Corners(mesh, t).middle() + isotropic(random) * (2 * random.uniform());
      const Vec3 along = isotropic(random);
      const double length_nm = std::pow(10, 2 * random.uniform() - 1);
      EmbreeScene::Hit among, overall;
      const bool a = scene.nearest_of(faces, start, along, length_nm, ahead, nullptr, among);
      const bool b = scene.nearest(start, along, length_nm, ahead, nullptr, overall);
      (a ? found : missed)++;
      if (a && b && among.triangle == overall.triangle) {
        ASSERT_EQ(among.position, overall.position);
        ASSERT_EQ(among.normal, overall.normal);
        ASSERT_EQ(among.distance, overall.distance);
        continue;
      }
      if (a == b && (!a || std::fabs(among.distance - overall.distance) < 1e-5)) continue;
      // Single precision may decide otherwise on rims, on ends and on what is grazed.
      ++nearby;
    }
    EXPECT_GT(found, 500);
    EXPECT_GT(missed, 500);
    EXPECT_LT(nearby, 3);
  }
}

// What starts on a surface within a rounding error behind it still meets it.
TEST(EmbreeScene, LooksForKnownTrianglesALittleBehind) {
  const EmbreeScene scene(make_box({-9, -9, -9}, {9, 9, 9}));
  const std::vector<std::uint32_t> faces = all(scene.mesh());
  const auto any = [](void*, std::uint32_t, double, double) { return true; };
  EmbreeScene::Hit hit;
  EXPECT_TRUE(scene.nearest_of(faces, {1, 2, 9 - 0.9e-3}, {0, 0, -1}, 1, any, nullptr, hit));
  EXPECT_EQ(hit.distance, 0);
  EXPECT_NEAR(hit.position.z, 9, 1e-12);
  EXPECT_FALSE(scene.nearest_of(faces, {1, 2, 9 - 1.1e-3}, {0, 0, -1}, 1, any, nullptr, hit));
  EXPECT_FALSE(scene.nearest_of(faces, {1, 2, 12}, {0, 0, -1}, 2.9, any, nullptr, hit));
  EXPECT_TRUE(scene.nearest_of(faces, {1, 2, 12}, {0, 0, -1}, 3.1, any, nullptr, hit));
  EXPECT_FALSE(scene.nearest_of({}, {1, 2, 12}, {0, 0, -1}, 3.1, any, nullptr, hit));
  // In its plane a path does not cross a triangle.
  EXPECT_FALSE(scene.nearest_of(faces, {-5, 2, 9}, {1, 0, 0}, 10, any, nullptr, hit));
}

TEST(EmbreeScene, TakesTheNearestThatIsAccepted) {
  const EmbreeScene scene(make_box({-9, -9, -9}, {9, 9, 9}));
  const std::vector<std::uint32_t> faces = all(scene.mesh());
  EmbreeScene::Hit hit;
  ASSERT_TRUE(scene.nearest_of(faces, {1, 2, 12}, {0, 0, -1}, 100, inward, nullptr, hit));
  EXPECT_NEAR(hit.distance, 3, 1e-12);
  EXPECT_EQ(hit.normal, (Vec3{0, 0, 1}));
  ASSERT_TRUE(scene.nearest_of(faces, {1, 2, 12}, {0, 0, -1}, 100, outward, nullptr, hit));
  EXPECT_NEAR(hit.distance, 21, 1e-12);
  std::vector<std::uint32_t> others = faces;
  std::erase(others, hit.triangle);
  EXPECT_FALSE(scene.nearest_of(others, {1, 2, 12}, {0, 0, -1}, 100, outward, nullptr, hit));
}

TEST(EmbreeScene, LetsNothingThroughBetweenTriangles) {
  for (const Body& body : bodies()) {
    SCOPED_TRACE(body.name);
    const EmbreeScene scene(body.mesh);
    const std::vector<std::uint32_t> faces = all(body.mesh);
    RandomStream random(3, 0, 0);
    for (std::uint32_t t = 0; t < body.mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Corners c(body.mesh, t);
        const Vec3 &a = c.v[k], &b = c.v[(k + 1) % 3];
        for (const Vec3& through : {a, (a + b) * 0.5, a + (b - a) * random.uniform()}) {
          const Vec3 aside = isotropic(random) * random.uniform();
          for (const Vec3& to : {body.center, body.center + aside}) {
            const Vec3 from = through + (through - to) * random.uniform();
            expect_in_and_out(scene, faces, from, through, to);
            if (HasFatalFailure()) return;
          }
        }
      }
  }
}

// All numbers are whole: edges are met without any rounding.
TEST(EmbreeScene, LetsNothingThroughExactlyOnEdges) {
  const EmbreeScene scene(make_box({-8, -8, -8}, {8, 8, 8}, 8));
  const std::vector<std::uint32_t> faces = all(scene.mesh());
  EmbreeScene::Hit hit;
  for (int x = -8; x <= 8; ++x)
    for (int y = -8; y <= 8; ++y)
      for (const Vec3& start : {Vec3{double(x), double(y), 20}, Vec3{x + 0.5, y + 0.5, 20}}) {
        const bool beside = std::max(std::fabs(start.x), std::fabs(start.y)) > 8;
        for (const bool down : {true, false}) {
          const Vec3 from{start.x, start.y, down ? 20.0 : -20.0}, along{0, 0, down ? -1.0 : 1.0};
          EXPECT_EQ(scene.nearest_of(faces, from, along, 100, inward, nullptr, hit), !beside);
          if (!beside) {
            EXPECT_EQ(hit.distance, 12);
          }
        }
      }
}

TEST(EmbreeScene, FindsAllTrianglesWithinABall) {
  for (const TriangleMesh& mesh :
       {height_field_sheet(make_rough({40, 40, 1}, 3, 5, 1)), make_box({-90, -9, -9}, {9, 9, 9}, 3),
        moved(make_sphere({0, 0, 0}, 20, 3), {1e6, 1e6, -1e6})}) {
    const EmbreeScene scene(mesh);
    RandomStream random(4, mesh.triangles.size(), 0);
    const Box box = bounds(mesh);
    const Vec3 size = box.size_nm();
    int complete = 0, too_many = 0;
    for (int i = 0; i < 1500; ++i) {
      const Vec3 point{box.lower_nm.x + size.x * random.uniform(),
                       box.lower_nm.y + size.y * random.uniform(),
                       box.lower_nm.z + size.z * random.uniform()};
      const double radius = std::pow(10, 3 * random.uniform() - 1);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Corners c(mesh, t);
        for (Vec3& v : c.v) v -= point;
        if (length(closest_point(c.v[0], c.v[1], c.v[2], {})) <= radius) expected.push_back(t);
      }
      constexpr std::size_t most = 100;
      std::vector<std::uint32_t> found{7, 7};  // stay
      const bool known = scene.within(point, radius, most, found);
      ASSERT_GE(found.size(), 2u);
      EXPECT_EQ(found[0] + found[1], 14u);
      found.erase(found.begin(), found.begin() + 2);
      if (expected.size() > most) {
        EXPECT_FALSE(known) << expected.size() << " triangles within " << radius;
      }
      if (!known) {
        ++too_many;
        continue;
      }
      ++complete;
      EXPECT_LE(found.size(), most);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "one came twice";
      EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()))
          << found.size() << " found of " << expected.size() << " within " << radius;
    }
    EXPECT_GT(complete, 100);
    EXPECT_GT(too_many, mesh.triangles.size() > 1000 ? 100 : -1);
  }
}

}  // namespace surf::mc
