// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"

namespace surf {
namespace {

/// Closed, normals outward, one piece, and topologically a sphere.
void expect_ball(const MeshReport& r) {
  EXPECT_TRUE(r.closed_and_oriented);
  EXPECT_EQ(r.degenerate_triangles + r.duplicate_triangles + r.nonmanifold_edges, 0u);
  EXPECT_EQ(r.components, 1u);
  EXPECT_GT(r.signed_volume_nm3, 0);
  EXPECT_EQ(r.vertices + r.triangles, 3 * r.triangles / 2 + 2);
}

template <class Call>
std::string refused_subject(const Call& call) {
  try {
    call();
  } catch (const UsageError& error) {
    EXPECT_FALSE(error.remedy().empty());
    return error.subject();
  }
  return "accepted";
}

void expect_symmetric(const Grid<double>& z) {
  for (int y = 0; y < z.height(); ++y) {
    for (int x = 0; x < z.width(); ++x) {
      ASSERT_EQ(z(x, y), z(z.width() - 1 - x, y));
      ASSERT_EQ(z(x, y), z(x, z.height() - 1 - y));
    }
  }
}

}  // namespace

TEST(MakeBox, HasTheAlgebraOfABox) {
  for (const int n : {1, 2, 3, 7, 16}) {
    const MeshReport r = check_mesh(make_box({-1, 0.1, 3}, {1.5, 7, 3.3}, n));
    const auto pieces = static_cast<std::size_t>(n);
    expect_ball(r);
    EXPECT_EQ(r.triangles, 12 * pieces * pieces);
    EXPECT_EQ(r.vertices, 6 * pieces * pieces + 2);
    EXPECT_NEAR(r.area_nm2, 2 * (2.5 * 6.9 + 6.9 * 0.3 + 2.5 * 0.3), 1e-12);
    EXPECT_NEAR(r.signed_volume_nm3, 2.5 * 6.9 * 0.3, 1e-12);
    EXPECT_EQ(r.bounds_nm.lower_nm, (Vec3{-1, 0.1, 3}));
    EXPECT_EQ(r.bounds_nm.upper_nm, (Vec3{1.5, 7, 3.3}));
  }
}

TEST(MakeBox, SharesItsVertices) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1}, 4);
  EXPECT_EQ(box.vertices_nm.size(), check_mesh(box).vertices);
}

TEST(MakeBox, RefusesBadArguments) {
  EXPECT_EQ(refused_subject([] { make_box({0, 0, 0}, {1, 1, 1}, 0); }), "subdivisions");
  EXPECT_EQ(refused_subject([] { make_box({0, 0, 0}, {1, 0, 1}); }), "size of the box along y");
  EXPECT_EQ(refused_subject([] { make_box({0, 0, 2}, {1, 1, 1}); }), "size of the box along z");
  EXPECT_EQ(refused_subject([] { make_box({NAN, 0, 0}, {1, 1, 1}); }), "size of the box along x");
}

TEST(MakeSphere, IsWatertightWithSharedVertices) {
  std::size_t triangles = 20;
  for (int n = 0; n <= 6; ++n, triangles *= 4) {
    const TriangleMesh mesh = make_sphere({5, -3, 100}, 7, n);
    const MeshReport r = check_mesh(mesh);
    expect_ball(r);
    EXPECT_EQ(r.triangles, triangles);
    EXPECT_EQ(r.vertices, mesh.vertices_nm.size()) << "no vertex exists twice";
    for (const Vec3& v : mesh.vertices_nm) ASSERT_NEAR(length(v - Vec3{5, -3, 100}), 7, 1e-11);
  }
}

TEST(MakeSphere, TheIcosahedronHasItsKnownVolumeAndArea) {
  const MeshReport r = check_mesh(make_sphere({0, 0, 0}, 1, 0));
  const double edge = 1 / std::sin(2 * std::numbers::pi / 5);  // circumradius 1
  EXPECT_NEAR(r.signed_volume_nm3, 5.0 / 12 * (3 + std::sqrt(5.0)) * edge * edge * edge, 1e-13);
  EXPECT_NEAR(r.area_nm2, 5 * std::sqrt(3.0) * edge * edge, 1e-13);
}

TEST(MakeSphere, ConvergesToASphereWithTheSquareOfTheEdge) {
  const double volume = 4 * std::numbers::pi / 3 * 8;
  double previous = 0;
  for (int n = 2; n <= 6; ++n) {
    const double missing = volume - check_mesh(make_sphere({1, 2, 3}, 2, n)).signed_volume_nm3;
    EXPECT_GT(missing, 0) << "the triangles lie inside";
    if (n > 2) {
      EXPECT_NEAR(previous / missing, 4, 0.1);
    }
    previous = missing;
  }
}

TEST(MakeSphere, RefusesBadArguments) {
  EXPECT_EQ(refused_subject([] { make_sphere({0, 0, 0}, 0); }), "radius");
  EXPECT_EQ(refused_subject([] { make_sphere({0, 0, 0}, NAN); }), "radius");
  EXPECT_EQ(refused_subject([] { make_sphere({0, 0, 0}, 1, -1); }), "subdivisions");
  EXPECT_EQ(refused_subject([] { make_sphere({0, 0, 0}, 1, 10); }), "subdivisions");
}

TEST(MakeMesa, IsATruncatedPyramid) {
  const HeightField field = make_mesa({40, 60, 2}, 50, 12, 8);
  ASSERT_EQ(field.z_nm.width(), 21);
  ASSERT_EQ(field.z_nm.height(), 31);
  EXPECT_EQ(field.origin_x_nm, -20);
  EXPECT_EQ(field.origin_y_nm, -30);
  expect_symmetric(field.z_nm);
  const auto height_at = [&](double x, double y) {
    return field.z_nm(static_cast<int>((x + 20) / 2), static_cast<int>((y + 30) / 2));
  };
  EXPECT_EQ(height_at(0, 0), 50);
  EXPECT_EQ(height_at(6, -6), 50) << "corner of the top";
  EXPECT_EQ(height_at(10, 0), 25) << "half-way down";
  EXPECT_EQ(height_at(8, 12), 12.5);
  EXPECT_EQ(height_at(14, 0), 0) << "foot";
  EXPECT_EQ(height_at(0, -30), 0);
}

TEST(MakeMesa, ZeroRunIsOnePitch) {
  EXPECT_EQ(make_mesa({40, 40, 2}, 50, 12, 0).z_nm, make_mesa({40, 40, 2}, 50, 12, 2).z_nm);
  const HeightField field = make_mesa({40, 40, 2}, 50, 12, 0);
  EXPECT_EQ(field.z_nm(13, 10), 50);
  EXPECT_EQ(field.z_nm(14, 10), 0);
}

TEST(MakeTrench, RunsAlongY) {
  const HeightField field = make_trench({40, 20, 2}, 30, 8, 4);
  ASSERT_EQ(field.z_nm.width(), 21);
  ASSERT_EQ(field.z_nm.height(), 11);
  expect_symmetric(field.z_nm);
  for (int y = 0; y < 11; ++y) {
    EXPECT_EQ(field.z_nm(10, y), -30);
    EXPECT_EQ(field.z_nm(12, y), -30) << "edge of the bottom";
    EXPECT_EQ(field.z_nm(13, y), -15);
    EXPECT_EQ(field.z_nm(14, y), 0);
    EXPECT_EQ(field.z_nm(20, y), 0);
  }
  EXPECT_FALSE(std::signbit(field.z_nm(20, 0)));
}

TEST(FieldExtent, RoundsToWholePitchesAndIsCentred) {
  const HeightField field = make_trench({10.9, 7.2, 2}, 1, 1, 0);
  EXPECT_EQ(field.z_nm.width(), 6);
  EXPECT_EQ(field.z_nm.height(), 5);
  EXPECT_EQ(field.x_nm(0), -field.x_nm(5));
  EXPECT_EQ(field.y_nm(0), -field.y_nm(4));
}

TEST(FieldExtent, RefusesWhatCannotBeSampled) {
  const auto trench = [](const FieldExtent& e) {
    return refused_subject([&] { make_trench(e, 1, 1, 0); });
  };
  EXPECT_EQ(trench({10, 10, 0}), "pitch");
  EXPECT_EQ(trench({10, 10, NAN}), "pitch");
  EXPECT_EQ(trench({-10, 10, 1}), "width");
  EXPECT_EQ(trench({10, 0, 1}), "depth");
  EXPECT_EQ(trench({10, 10, 30}), "width");
  EXPECT_EQ(trench({1e9, 10, 1}), "width");
}

TEST(MakeShapes, RefuseBadLengths) {
  EXPECT_EQ(refused_subject([] { make_mesa({}, 0, 1, 1); }), "height of the mesa");
  EXPECT_EQ(refused_subject([] { make_mesa({}, 1, -1, 1); }), "top width of the mesa");
  EXPECT_EQ(refused_subject([] { make_mesa({}, 1, 1, -1); }), "wall run of the mesa");
  EXPECT_EQ(refused_subject([] { make_trench({}, NAN, 1, 1); }), "depth of the trench");
  EXPECT_EQ(refused_subject([] { make_trench({}, 1, 0, 1); }), "bottom width of the trench");
  EXPECT_EQ(refused_subject([] { make_trench({}, 1, 1, -1); }), "wall run of the trench");
}

}  // namespace surf
