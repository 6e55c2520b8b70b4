// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/scene.h"

#include <functional>

#include "specimens.h"
#include "statistics.h"
#include "surf/core/random.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

using test::square_scan;

Specimen nested() {
  Specimen s;
  s.materials = {io::find_material("Si", "test"), io::find_material("Au", "test")};
  return s;
}

void expect_balanced(const Balance& b) {
  EXPECT_EQ(b.incident + b.generated, b.se + b.bse + b.transmitted + b.absorbed + b.total_lost());
  const double in = b.incident_energy.ev() + b.generated_energy.ev();
  const double out = b.escaped_energy.ev() + b.deposited_energy.ev() + b.lost_energy.ev();
  EXPECT_NEAR(out, in, static_cast<double>(b.incident + b.generated) * 3 * 0x1p-17);
}

// Checks that every path inside a material is where that material is.
class Inside final : public Observer {
 public:
  explicit Inside(std::function<int(const Vec3&)> material) : material_(std::move(material)) {}
  void segment(const Vec3& a, const Vec3& b, double, double, int material) override {
    const Vec3 middle = (a + b) * 0.5;
    if (length(b - a) < 0.02) return;  // too near a surface to tell
    ++segments;
    wrong += material_(middle) != material ? 1 : 0;
  }
  std::int64_t segments = 0, wrong = 0;

 private:
  std::function<int(const Vec3&)> material_;
};

Balance observe(const Scene& scene, Observer& observer, int electrons) {
  return simulate_unit(scene, test::seeded(1),
                       {0, 0, scene.scan().width, scene.scan().height, 0, electrons}, &observer)
      .balance;
}

}  // namespace

TEST(Scene, FindsTheFirstSurface) {
  Specimen s = test::flat("Si");
  s.bodies.push_back({"box", make_box({-10, -10, 0}, {10, 10, 30}), 0});
  const Scene scene(s, {}, square_scan(40, 4));
  Vec3 hit;
  ASSERT_TRUE(scene.first_surface({1, 2, 100}, {0, 0, -1}, hit));
  EXPECT_NEAR(hit.z, 30, 1e-9);
  ASSERT_TRUE(scene.first_surface({15, 2, 100}, {0, 0, -1}, hit));
  EXPECT_NEAR(hit.z, 0, 1e-9);
  EXPECT_FALSE(scene.first_surface({15, 2, 100}, {0, 0, 1}, hit));
}

// Rays aimed exactly at edges, corners and diagonals of a fine mesh never slip through.
TEST(Scene, HasNoCracks) {
  Specimen s = nested();
  s.bodies.push_back({"ball", make_sphere({3, -2, 1}, 40, 3), 0});
  const Scene scene(s, {}, square_scan(100, 4));
  const TriangleMesh& mesh = s.bodies[0].mesh;
  RandomStream random(1, 0, 0);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.vertices_nm[t[static_cast<std::size_t>(k)]],
                 &b = mesh.vertices_nm[t[static_cast<std::size_t>((k + 1) % 3)]];
      for (const Vec3& target : {a, (a + b) * 0.5, a + (b - a) * random.uniform()}) {
        const Vec3 from{300 * (random.uniform() - 0.5), 300 * (random.uniform() - 0.5), 300};
        Vec3 hit;
        // Only what faces the start is met there: facets turn from the sphere by up to 4 degrees.
        if (dot(target - Vec3{3, -2, 1}, from - target) < 1700) continue;
        ASSERT_TRUE(scene.first_surface(from, normalized(target - from), hit));
        ASSERT_LT(length(hit - target), 1e-3);
      }
    }
}

TEST(Scene, KeepsElectronsWhereTheirMaterialIs) {
  // Gold ball inside a silicon box on a gold substrate, the box's bottom on the substrate's top.
  Specimen s = nested();
  s.substrate = Substrate{1, 0};
  s.bodies.push_back({"box", make_box({-20, -20, 0}, {20, 20, 40}, 3), 0});
  s.bodies.push_back({"ball", make_sphere({0, 0, 34}, 10, 4), 1});
  const Scene scene(s, {}, square_scan(60, 12));
  const double ball = 10;
  Inside observer([&](const Vec3& p) {
    const double r = length(p - Vec3{0, 0, 34});
    if (r < ball * 0.995) return 1;
    if (r < ball + 1e-9) return -2;  // between the facets and the sphere: either
    if (std::fabs(p.x) < 20 && std::fabs(p.y) < 20 && p.z > 0 && p.z < 40) return 0;
    return p.z < 0 ? 1 : -1;
  });
  const Balance b = observe(scene, observer, 20);
  EXPECT_EQ(b.total_lost(), 0);
  expect_balanced(b);
  EXPECT_GT(observer.segments, 10000);
  // Only paths in the thin gap between facets and sphere may disagree.
  EXPECT_LT(static_cast<double>(observer.wrong) / static_cast<double>(observer.segments), 0.01);
}

TEST(Scene, LosesNobodyOnClosedBodies) {
  for (const int subdivisions : {0, 2, 5}) {
    Specimen s = nested();
    s.bodies.push_back({"ball", make_sphere({0, 0, 0}, 30, subdivisions), 1});
    const auto result = test::simulate(s, {}, square_scan(50, 20), 100);
    EXPECT_EQ(result.balance.total_lost(), 0);
    expect_balanced(result.balance);
  }
}

TEST(Scene, TreatsFacesThatCoincideAsOneInterface) {
  // Two silicon boxes side by side, sharing a face, on silicon: the same as one box. The gap of
  // 5e-4 nm below the third counts as none.
  Specimen one = test::flat("Si"), parts = test::flat("Si");
  one.bodies.push_back({"box", make_box({-30, -30, 0}, {30, 30, 20}), 0});
  parts.bodies.push_back({"left", make_box({-30, -30, 0}, {0, 30, 20}), 0});
  parts.bodies.push_back({"right", make_box({0, -30, 5e-4}, {30, 30, 20}), 0});
  const auto a = test::yields(test::simulate(one, {}, square_scan(90, 12), 400));
  const auto b = test::yields(test::simulate(parts, {}, square_scan(90, 12), 400, {}, 2));
  test::expect_mean(a.se.mean - b.se.mean, std::hypot(a.se.standard_error, b.se.standard_error), 0,
                    2);
  test::expect_mean(a.bse.mean - b.bse.mean, std::hypot(a.bse.standard_error, b.bse.standard_error),
                    0, 2);
}

TEST(Scene, LetsTheLaterBodyWinWhereTwoOverlap) {
  Specimen s = nested();
  s.bodies.push_back({"silicon", make_box({-50, -50, -100}, {50, 50, 0}), 0});
  s.bodies.push_back({"gold", make_box({-50, -50, -60}, {50, 50, 0.0}), 1});
  const double gold = test::yields(test::simulate(s, {}, square_scan(20, 4), 500)).bse.mean;
  std::swap(s.bodies[0], s.bodies[1]);
  const double silicon = test::yields(test::simulate(s, {}, square_scan(20, 4), 500)).bse.mean;
  EXPECT_GT(gold, 0.35);
  EXPECT_LT(silicon, 0.3);
}

TEST(Scene, SeesHollowsInBodies) {
  // A shell of gold, 2 nm thick, around nothing: the beam comes out below.
  Specimen s = nested();
  TriangleMesh shell = make_box({-50, -50, -50}, {50, 50, 50});
  const TriangleMesh hole = make_box({-48, -48, -48}, {48, 48, 48});
  const auto base = static_cast<std::uint32_t>(shell.vertices_nm.size());
  shell.vertices_nm.insert(shell.vertices_nm.end(), hole.vertices_nm.begin(),
                           hole.vertices_nm.end());
  for (const Triangle& t : hole.triangles)
    shell.triangles.push_back({base + t[0], base + t[2], base + t[1]});
  s.bodies.push_back({"shell", shell, 1});
  Beam beam;
  beam.energy_ev = 20000;
  const auto r = test::simulate(s, beam, square_scan(20, 4), 100);
  EXPECT_GT(r.balance.transmitted, 1400);
  EXPECT_EQ(r.balance.total_lost(), 0);
}

// `validate` takes such a mesh and says so.
TEST(Scene, TurnsABodyWhoseNormalsPointInward) {
  TriangleMesh hollow = make_box({-20, -20, -20}, {20, 20, 20});
  const TriangleMesh hole = make_box({-10, -10, -10}, {10, 10, 10});
  for (const Triangle& t : hole.triangles)
    hollow.triangles.push_back({8 + t[0], 8 + t[2], 8 + t[1]});
  ASSERT_EQ(hollow.vertices_nm.size(), 8u);
  hollow.vertices_nm.insert(hollow.vertices_nm.end(), hole.vertices_nm.begin(),
                            hole.vertices_nm.end());
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  Specimen s = nested();
  s.bodies.push_back({"hollow", hollow, 1});
  const Scene scene(s, {}, square_scan(60, 12));
  Inside observer([&](const Vec3& p) {
    const double r = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    return r > 10 && r < 20 ? 1 : -1;
  });
  const Balance b = observe(scene, observer, 20);
  EXPECT_EQ(b.total_lost(), 0);
  expect_balanced(b);
  EXPECT_GT(b.absorbed, 1000);
  EXPECT_GT(observer.segments, 10000);
  EXPECT_LE(observer.wrong, observer.segments / 1000);
}

TEST(Scene, LeavesOutWhatNoElectronReachesAndChangesNothing) {
  Specimen s = nested();
  s.bodies.push_back({"block", make_box({-200, -200, -600}, {200, 200, 0}, 4), 0});
  s.bodies.push_back({"buried", make_box({-50, -50, -400}, {50, 50, -300}, 4), 1});
  const Scan scan = square_scan(40, 4);
  const Scene all(make_surfaces(s, validate(s), {}, scan, {}, {.leave_out_unreachable = false}),
                  s.materials, {}, scan);
  const Scene some(s, {}, scan);
  EXPECT_EQ(all.summary().triangles_left_out, 0u);
  EXPECT_GE(some.summary().triangles_left_out, 12u);  // the merged box
  EXPECT_EQ(some.summary().triangles + some.summary().triangles_left_out, all.summary().triangles);
  const auto nowhere = [](const Vec3&) { return 0; };
  // Watched, so that no electron is given up early: which ones are depends on the bounds.
  Inside one(nowhere), other(nowhere);
  const Balance a = observe(all, one, 20), b = observe(some, other, 20);
  EXPECT_EQ(one.segments, other.segments);
  EXPECT_EQ(a.se, b.se);
  EXPECT_EQ(a.bse, b.bse);
  EXPECT_EQ(a.absorbed, b.absorbed);
  EXPECT_EQ(a.escaped_energy.ev(), b.escaped_energy.ev());
  EXPECT_EQ(a.deposited_energy.ev(), b.deposited_energy.ev());
}

TEST(Scene, MissesAreMarked) {
  Specimen s = nested();
  s.bodies.push_back({"ball", make_sphere({0, 0, 0}, 10, 3), 0});
  const Scan scan = square_scan(80, 8);
  const auto r = test::simulate(s, {}, scan, 20);
  const Image image = make_image(r, scan);
  EXPECT_EQ(image.find("valid")->values(0, 0), 0);
  EXPECT_EQ(image.find("SE")->values(0, 0), 0);
  EXPECT_EQ(image.find("valid")->values(4, 4), 1);
  EXPECT_GT(r.balance.missed, 0);
}

}  // namespace surf::mc
