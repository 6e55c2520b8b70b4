// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/local_surface.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh_test.h"
#include "surf/core/random.h"
#include "surf/mesh/height_field_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

using Answer = LocalSurface::Crossed::Answer;

struct Place {
  std::string name;
  TriangleMesh mesh;
  std::optional<double> plane_nm;
  Vec3 origin, normal;
};

std::ostream& operator<<(std::ostream& out, const Place& p) { return out << p.name; }

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  transform(mesh, 1, by);
  return mesh;
}

// The first point of a sheet below (x, y), with the normal of its triangle.
Place on_sheet(std::string name, TriangleMesh mesh, double x, double y) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices_nm[t[0]], &b = mesh.vertices_nm[t[1]],
               &c = mesh.vertices_nm[t[2]];
    const auto side = [&](const Vec3& p, const Vec3& q) {
      return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
    };
    if (side(a, b) < 0 || side(b, c) < 0 || side(c, a) < 0) continue;
    const Vec3 n = normalized(cross(b - a, c - a));
    if (!(n.z > 0)) continue;
    const Vec3 at{x, y, a.z - (n.x * (x - a.x) + n.y * (y - a.y)) / n.z};
    return {std::move(name), std::move(mesh), {}, at, n};
  }
  ADD_FAILURE() << "nothing of " << name << " at " << x << ", " << y;
  return {};
}

// Slivers far longer than wide, down to a line, among ordinary triangles.
TriangleMesh needles() {
  TriangleMesh mesh = height_field_sheet(make_rough({40, 40, 4}, 2, 10, 3));
  RandomStream random(1, 2, 3);
  for (int i = 0; i < 60; ++i) {
    const Vec3 a{40 * random.uniform() - 20, 40 * random.uniform() - 20, 10 * random.uniform() - 5};
    const Vec3 way{20 * random.uniform() - 10, 20 * random.uniform() - 10,
                   8 * random.uniform() - 4};
    const Vec3 aside =
        normalized(cross(way, {0.3, 0.2, 1})) * std::pow(10.0, -10 * random.uniform());
    const Vec3 b = i % 10 == 0 ? a + way * 0.5 : a + way * 0.5 + aside;
    test::append(mesh, {{a, a + way, b}, {{0, 1, 2}}});
  }
  return mesh;
}

std::vector<Place> places() {
  const TriangleMesh gentle = height_field_sheet(make_rough({200, 200, 2}, 2, 30, 1));
  const TriangleMesh steep = height_field_sheet(make_rough({100, 100, 1}, 8, 6, 2));
  const TriangleMesh fine = height_field_sheet(make_rough({20, 20, 0.4}, 0.5, 2, 4));
  const TriangleMesh mesa = height_field_sheet(make_mesa({200, 200, 2}, 100, 80, 2));
  const TriangleMesh cube = make_box({-50, -50, 0}, {50, 50, 100});
  const TriangleMesh membrane = make_box({-60, -60, -0.4}, {60, 60, 0.4}, 12);
  const Vec3 slanted = normalized({0.4, -0.5, 0.7});
  std::vector<Place> out{
      on_sheet("gentle", gentle, 11.3, -7.9),
      on_sheet("steep", steep, -3.7, 5.1),
      on_sheet("fine", fine, 0.33, 0.71),
      on_sheet("far from the origin", moved(steep, {1e6, -1e6, 1e6}), 1e6 - 3.7, -1e6 + 5.1),
      on_sheet("mesa's top", mesa, 38.7, 3.1),
      on_sheet("mesa's wall", mesa, 41.3, 3.1),
      on_sheet("mesa's foot", mesa, 43.1, 3.1),
      on_sheet("needles", needles(), 1.7, 0.3),
      {"cube's corner", cube, -1.0, {49.6, 49.7, 100}, {0, 0, 1}},
      {"cube's foot", cube, 0.0, {50, 12, 1.5}, {1, 0, 0}},
      {"cube over a plane", moved(cube, {0, 0, 3}), 0.0, {20, 20, 3}, {0, 0, -1}},
      {"plane beside a cube", cube, 0.0, {52, 20, 0}, {0, 0, 1}},
      {"slanted cube over a plane", cube, -7.0, {49, 49, 99}, slanted},
      {"membrane", membrane, {}, {3.3, -4.1, 0.4}, {0, 0, 1}},
      {"membrane's rim", membrane, {}, {59.9, -4.1, 0.4}, normalized({1, 0, 1})},
  };
  Place turned = out[1];
  turned.name = "steep, slanted";
  turned.normal = slanted;
  out.push_back(turned);
  turned.name = "steep, upside down";
  turned.normal = {0, 0, -1};
  out.push_back(turned);
  return out;
}

// A mesh in a patch's frame, in double, and what is about the origin.
struct Around {
  EmbreeScene scene;
  LocalSurface patch;
  Vec3 up;                    // the specimen's z
  std::optional<double> gap;  // the endless plane is up.p = gap
  struct Corners {
    Vec3 v[3];
    std::uint32_t number;
  };
  std::vector<Corners> triangles;

  explicit Around(const Place& p)
      : scene(p.mesh), patch(scene, p.plane_nm, p.origin, p.normal),
        up(patch.frame().direction_in({0, 0, 1})) {
    if (p.plane_nm) gap = *p.plane_nm - p.origin.z;
    const double reach = patch.reach_nm();
    for (std::uint32_t i = 0; i < p.mesh.triangles.size(); ++i) {
      Corners c{{}, i};
      Box box;
      for (std::size_t k = 0; k < 3; ++k) {
        c.v[k] = patch.frame().in(p.mesh.vertices_nm[p.mesh.triangles[i][k]]);
        box.extend(c.v[k]);
      }
      const Vec3 &low = box.lower_nm, &high = box.upper_nm;
      if (std::max({low.x, low.y, low.z}) < reach && std::min({high.x, high.y, high.z}) > -reach)
        triangles.push_back(c);
    }
  }
};

struct Heights {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void extend(double z) {
    low = std::min(low, z);
    high = std::max(high, z);
  }
};

// Of what a ball holds of the plane n.p = offset: its highest and lowest points, if `holds` them.
template <class Holds>
void extend_by_disc(Heights& heights, const Vec3& center, double radius, const Vec3& n,
                    double offset, const Holds& holds) {
  const double away = offset - dot(n, center);
  if (std::fabs(away) > radius) return;
  const Vec3 middle = center + n * away;
  const Vec3 steepest = Vec3{0, 0, 1} - n * n.z;
  const double slope = length(steepest);
  const Vec3 to =
      slope > 1e-7 ? steepest * (std::sqrt(radius * radius - away * away) / slope) : Vec3{};
  for (const Vec3& p : {middle + to, middle - to})
    if (holds(p)) heights.extend(p.z);
}

// Of what a ball holds of a triangle: extremes are at corners, where edges leave the ball, or at
// those of the disc.
void extend_by_triangle(Heights& heights, const Vec3& center, double radius, const Vec3 (&v)[3]) {
  for (int i = 0; i < 3; ++i) {
    const Vec3& a = v[i];
    const Vec3 way = v[(i + 1) % 3] - a, from = a - center;
    if (length(from) <= radius) heights.extend(a.z);
    const double squared = dot(way, way), half = dot(from, way);
    const double root = half * half - squared * (dot(from, from) - radius * radius);
    if (!(squared > 0) || root < 0) continue;
    for (const double t :
         {(-half - std::sqrt(root)) / squared, (-half + std::sqrt(root)) / squared})
      if (t >= 0 && t <= 1) heights.extend(a.z + way.z * t);
  }
  const Vec3 across = cross(v[1] - v[0], v[2] - v[0]);
  if (!(length(across) > 1e-12)) return;
  const Vec3 n = normalized(across);
  extend_by_disc(heights, center, radius, n, dot(n, v[0]), [&](const Vec3& p) {
    for (int i = 0; i < 3; ++i)
      if (dot(cross(v[(i + 1) % 3] - v[i], p - v[i]), n) < 0) return false;
    return true;
  });
}

Heights heights_in(const Around& around, const Vec3& center, double radius) {
  Heights heights;
  for (const Around::Corners& t : around.triangles)
    extend_by_triangle(heights, center, radius, t.v);
  if (around.gap)
    extend_by_disc(heights, center, radius, around.up, *around.gap,
                   [](const Vec3&) { return true; });
  return heights;
}

// From `least` to `most`, each size as likely as twice it.
double of_any_size(RandomStream& random, double least, double most) {
  return least * std::pow(most / least, random.uniform());
}

Vec3 isotropic(RandomStream& random) {
  const double c = 1 - 2 * random.uniform(), f = 6.283185307 * random.uniform();
  const double s = std::sqrt(1 - c * c);
  return {s * std::cos(f), s * std::sin(f), c};
}

// Near the surface as often as anywhere, near the origin as often as far away.
Vec3 somewhere(const Around& around, double away, RandomStream& random) {
  if (random.uniform() < 0.5 || around.triangles.empty()) return isotropic(random) * away;
  const double count = static_cast<double>(around.triangles.size());
  const Vec3(&v)[3] = around.triangles[static_cast<std::size_t>(random.uniform() * count)].v;
  double s = random.uniform(), t = random.uniform();
  if (s + t > 1) {
    s = 1 - s;
    t = 1 - t;
  }
  return v[0] + (v[1] - v[0]) * s + (v[2] - v[0]) * t + isotropic(random) * (0.02 * away);
}

// Whether the way from a to b meets a triangle, its rim included: in its plane, nobody asks.
bool meets(const Vec3& a, const Vec3& b, const Vec3 (&v)[3]) {
  const Vec3 n = cross(v[1] - v[0], v[2] - v[0]);
  const double from = dot(a - v[0], n), to = dot(b - v[0], n);
  if (from == to || (from > 0 && to > 0) || (from < 0 && to < 0)) return false;
  const Vec3 at = a + (b - a) * (from / (from - to));
  for (int i = 0; i < 3; ++i)
    if (dot(cross(v[(i + 1) % 3] - v[i], at - v[i]), n) < 0) return false;
  return true;
}

bool meets_plane(const Around& around, const Vec3& a, const Vec3& b) {
  if (!around.gap) return false;
  const double from = dot(around.up, a) - *around.gap, to = dot(around.up, b) - *around.gap;
  return std::min(from, to) <= 0 && std::max(from, to) >= 0;
}

class SurfacePatchOf : public testing::TestWithParam<Place> {};

struct Tried {
  int answered = 0, crossings = 0;
};

// What a patch says of a way, against all triangles.
void expect_all_crossed(const Around& around, const Float4& a, const Float4& b, Tried& tried) {
  LocalSurface::Crossed crossed;
  around.patch.crossed(a, b, crossed);
  if (crossed.answer == Answer::unknown || crossed.answer == Answer::crowded) return;
  ++tried.answered;
  ASSERT_LE(crossed.count, crossed.triangles.size());
  const auto end = crossed.triangles.begin() +
                   static_cast<std::ptrdiff_t>(crossed.answer == Answer::some ? crossed.count : 0);
  // Searches begin a little before a way.
  const Vec3 to = vec3(b), way = to - vec3(a);
  const Vec3 from = vec3(a) - way * (1e-3 / length(way));
  const auto where = [&] {
    return testing::Message() << "from " << from.x << ", " << from.y << ", " << from.z << " by "
                              << way.x << ", " << way.y << ", " << way.z;
  };
  for (const Around::Corners& t : around.triangles) {
    if (!meets(from, to, t.v)) continue;
    ++tried.crossings;
    ASSERT_TRUE(std::find(crossed.triangles.begin(), end, t.number) != end)
        << "triangle " << t.number << " " << where();
  }
  if (meets_plane(around, from, to)) {
    ++tried.crossings;
    ASSERT_EQ(crossed.answer, Answer::some) << "the plane " << where();
  }
}

}  // namespace

TEST_P(SurfacePatchOf, KnowsHeightsThatHoldAllSurface) {
  const Around around(GetParam());
  ASSERT_FALSE(around.patch.empty());
  const double reach = around.patch.reach_nm();
  RandomStream random(1, 1, 1);
  int near = 0, near_known = 0, held = 0;
  for (int i = 0; i < 6000; ++i) {
    const double away = of_any_size(random, 0.05, 1.2 * reach);
    const Float4 center = float4(somewhere(around, away, random));
    const auto radius = static_cast<float>(of_any_size(random, 1e-3, reach));
    const Band band = around.patch.band(center, radius);
    const Vec3 c = vec3(center);
    const double farthest =
        std::max({std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)}) + double(radius);
    if (farthest < 0.5 * reach) {
      ++near;
      near_known += band.is_known();
    }
    if (!band.is_known()) continue;
    EXPECT_LT(farthest, 1.001 * reach);
    const Heights heights = heights_in(around, c, double(radius));
    if (!(heights.low <= heights.high)) continue;
    ++held;
    ASSERT_LE(double(band.low), heights.low) << c.x << " " << c.y << " " << c.z << ", " << radius;
    ASSERT_GE(double(band.high), heights.high) << c.x << " " << c.y << " " << c.z << ", " << radius;
  }
  EXPECT_GT(near, 500);
  EXPECT_EQ(near_known, near);
  EXPECT_GT(held, 300);
}

TEST_P(SurfacePatchOf, KnowsAllTrianglesOnAWay) {
  const Around around(GetParam());
  const double reach = around.patch.reach_nm();
  RandomStream random(2, 1, 1);
  Tried tried, short_ones;
  for (int i = 0; i < 6000; ++i) {
    const Vec3 at = somewhere(around, of_any_size(random, 0.05, reach), random);
    // Ways are along the surface as often as in any direction.
    Vec3 along = isotropic(random);
    if (i % 3 == 0) along = normalized({along.x, along.y, 0.01 * along.z});
    const double length_nm = of_any_size(random, 1e-3, 0.5 * reach);
    const Vec3 from = at - along * (length_nm * random.uniform());
    Tried& t = length_nm < 1 ? short_ones : tried;
    expect_all_crossed(around, float4(from), float4(from + along * length_nm), t);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(short_ones.answered + tried.answered, 1000);
  EXPECT_GT(short_ones.crossings, 20);
}

// Ways that graze a triangle leave its plane's place to rounding, just where its rim is.
TEST_P(SurfacePatchOf, KnowsTrianglesThatAreGrazedAtTheirRim) {
  const Around around(GetParam());
  RandomStream random(3, 1, 1);
  Tried tried;
  const double count = static_cast<double>(around.triangles.size());
  for (int i = 0; i < 20000; ++i) {
    const Vec3(&v)[3] = around.triangles[static_cast<std::size_t>(random.uniform() * count)].v;
    const Vec3 across = cross(v[1] - v[0], v[2] - v[0]);
    if (!(length(across) > 1e-9)) continue;
    const Vec3 n = normalized(across);
    const auto k = static_cast<std::size_t>(random.uniform() * 3);
    const Vec3& corner = v[k];
    const Vec3 rim = corner + (v[(k + 1) % 3] - corner) * random.uniform() +
                     (v[(k + 2) % 3] - corner) * (1e-3 * random.uniform());
    const Vec3 any = isotropic(random);
    const Vec3 along = normalized(any - n * dot(any, n));
    const double length_nm = of_any_size(random, 0.01, 4);
    const Vec3 way = along * length_nm + n * of_any_size(random, 1e-7, 0.1);
    const Vec3 from = rim - way * random.uniform();
    expect_all_crossed(around, float4(from), float4(from + way), tried);
    if (testing::Test::HasFatalFailure()) return;
  }
  RecordProperty("crossings", tried.crossings);
  EXPECT_GT(tried.crossings, 100);
}

TEST_P(SurfacePatchOf, TakesLittleMemory) {
  const Around around(GetParam());
  EXPECT_GT(around.patch.reach_nm(), 0);
  EXPECT_LE(around.patch.reach_nm(), 64);
  EXPECT_GT(around.patch.bytes(), 0u);
  EXPECT_LT(around.patch.bytes(), 200000u);
}

INSTANTIATE_TEST_SUITE_P(Places, SurfacePatchOf, testing::ValuesIn(places()),
                         [](const auto& place) {
                           std::string name;
                           for (const char c : place.param.name)
                             if (std::isalnum(static_cast<unsigned char>(c))) name += c;
                           return name;
                         });

TEST(LocalSurface, KnowsNothingWhereTrianglesAreTooMany) {
  const EmbreeScene dust(height_field_sheet(make_rough({4, 4, 0.05}, 0.2, 1, 1)));
  const LocalSurface patch(dust, {}, {0, 0, 0}, {0, 0, 1});
  EXPECT_TRUE(patch.empty());
  EXPECT_FALSE(patch.band(Float4{}, 0.1f).is_known());
  LocalSurface::Crossed crossed;
  patch.crossed(Float4{0, 0, 1, 0}, Float4{0, 0, -1, 0}, crossed);
  EXPECT_EQ(crossed.answer, Answer::unknown);
}

TEST(LocalSurface, KnowsThatNothingIsThere) {
  const EmbreeScene away(make_sphere({500, 0, 0}, 10, 2));
  const LocalSurface patch(away, {}, {0, 0, 0}, {0, 0, 1});
  EXPECT_EQ(patch.reach_nm(), 64);
  EXPECT_TRUE(patch.band(Float4{3, 4, 5, 0}, 20).is_clear(5, 20));
  LocalSurface::Crossed crossed;
  patch.crossed(Float4{0, 0, 30, 0}, Float4{0, 0, -30, 0}, crossed);
  EXPECT_EQ(crossed.answer, Answer::none);
}

TEST(LocalSurface, SaysNothingOfBallsBeyondItsReach) {
  const EmbreeScene cube(make_box({-50, -50, -50}, {50, 50, 0}));
  const LocalSurface patch(cube, {}, {0, 0, 0}, {0, 0, 1});
  EXPECT_TRUE(patch.band(Float4{40, 0, 0, 0}, 20).is_known());
  EXPECT_FALSE(patch.band(Float4{40, 0, 0, 0}, 25).is_known());
  EXPECT_FALSE(patch.band(Float4{0, -70, 0, 0}, 1).is_known());
}

// Where many triangles are, halves of a way have few.
TEST(LocalSurface, CallsLongWaysAmongManyTrianglesCrowded) {
  const Place fine =
      on_sheet("fine", height_field_sheet(make_rough({21, 21, 0.7}, 0.5, 4, 4)), 0, 0);
  const EmbreeScene scene(fine.mesh);
  const LocalSurface patch(scene, {}, fine.origin, fine.normal);
  LocalSurface::Crossed crossed;
  patch.crossed(Float4{-1, 0, 1, 0}, Float4{1, 0, -1, 0}, crossed);
  EXPECT_EQ(crossed.answer, Answer::crowded);
  patch.crossed(Float4{-0.05f, 0, 0.05f, 0}, Float4{0.05f, 0, -0.05f, 0}, crossed);
  EXPECT_EQ(crossed.answer, Answer::some);
}

}  // namespace surf::mc
