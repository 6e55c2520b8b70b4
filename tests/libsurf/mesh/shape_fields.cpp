// SPDX-License-Identifier: GPL-3.0-or-later
// Cone, line, via, step and grating of surf/mesh/shapes.h.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "surf/core/error.h"
#include "surf/mesh/check_mesh.h"
#include "surf/mesh/shapes.h"

namespace surf {
namespace {

/// The height at x, y of a field of pitch 1.
double at(const HeightField& f, double x, double y) {
  return f.z_nm(static_cast<int>(std::lround(x - f.origin_x_nm)),
                static_cast<int>(std::lround(y - f.origin_y_nm)));
}

}  // namespace

TEST(MakeCone, HasTheAlgebraOfAFrustum) {
  for (const double top : {0.0, 2.0, 5.0, 8.0}) {
    for (const int n : {3, 4, 64}) {
      const MeshReport r = check_mesh(make_cone({1, 2, 3}, 5, top, 7, n));
      EXPECT_TRUE(r.closed_and_oriented);
      EXPECT_EQ(r.nonmanifold_edges + r.degenerate_triangles + r.nonmanifold_vertices, 0u);
      // The base is a regular polygon of area n/2 r^2 sin(2 pi / n).
      const double unit = 0.5 * n * std::sin(2 * std::numbers::pi / n);
      EXPECT_NEAR(r.signed_volume_nm3, unit * 7 / 3 * (25 + 5 * top + top * top), 1e-9);
      EXPECT_EQ(r.bounds_nm.lower_nm.z, 3);
      EXPECT_EQ(r.bounds_nm.upper_nm.z, 10);
      EXPECT_EQ(r.bounds_nm.upper_nm.x, 1 + std::max(5.0, top));
    }
  }
}

TEST(MakeLine, RunsAlongY) {
  const HeightField f = make_line({40, 20, 1}, 30, 8, 4);
  for (const double y : {-10.0, 0.0, 10.0}) {
    EXPECT_EQ(at(f, 0, y), 30);
    EXPECT_EQ(at(f, -4, y), 30) << "edge of the top";
    EXPECT_EQ(at(f, 6, y), 15);
    EXPECT_EQ(at(f, 8, y), 0);
    EXPECT_EQ(at(f, -20, y), 0);
  }
}

TEST(MakeVia, IsRound) {
  const HeightField f = make_via({60, 60, 1}, 30, 20, 10);
  EXPECT_EQ(at(f, 0, 0), -30);
  EXPECT_EQ(at(f, 6, -8), -30) << "10 from the middle: the edge of the bottom";
  EXPECT_EQ(at(f, 9, 12), -15) << "15 from the middle";
  EXPECT_EQ(at(f, -15, 0), -15);
  EXPECT_EQ(at(f, 12, 16), 0);
  EXPECT_EQ(at(f, 14, 14), at(f, -14, 14));
  EXPECT_FALSE(std::signbit(at(f, 30, 30)));
}

TEST(MakeStep, GoesUpToTheRight) {
  const HeightField f = make_step({40, 20, 1}, 12, 8);
  EXPECT_EQ(at(f, -20, 3), 0);
  EXPECT_EQ(at(f, -4, 3), 0);
  EXPECT_EQ(at(f, 0, 3), 6);
  EXPECT_EQ(at(f, 2, -10), 9);
  EXPECT_EQ(at(f, 4, 3), 12);
  EXPECT_EQ(at(f, 20, 3), 12);
  EXPECT_EQ(make_step({40, 20, 1}, 12, 0).z_nm, make_step({40, 20, 1}, 12, 1).z_nm);
}

TEST(MakeGrating, RepeatsItsLine) {
  const HeightField f = make_grating({100, 10, 1}, 9, 20, 6, 3);
  for (int x = -50; x <= 50; ++x) {
    const double from_line = std::abs(std::remainder(x, 20.0));
    EXPECT_DOUBLE_EQ(at(f, x, 0), 9 * std::clamp(1 - (from_line - 3) / 3, 0.0, 1.0)) << x;
  }
  EXPECT_THROW(make_grating({100, 10, 1}, 9, 12, 6, 3), UsageError) << "no space in between";
}

TEST(MakeShapes, NewOnesRefuseBadLengths) {
  EXPECT_THROW(make_cone({}, 0, 1, 1), UsageError);
  EXPECT_THROW(make_cone({}, 1, -1, 1), UsageError);
  EXPECT_THROW(make_cone({}, 1, 1, NAN), UsageError);
  EXPECT_THROW(make_cone({}, 1, 1, 1, 2), UsageError);
  EXPECT_THROW(make_line({}, 0, 1, 1), UsageError);
  EXPECT_THROW(make_line({}, 1, 0, 1), UsageError);
  EXPECT_THROW(make_via({}, 1, 1, -1), UsageError);
  EXPECT_THROW(make_via({}, NAN, 1, 1), UsageError);
  EXPECT_THROW(make_step({}, 0, 1), UsageError);
  EXPECT_THROW(make_step({}, 1, -1), UsageError);
  EXPECT_THROW(make_grating({}, 1, 0, 1, 1), UsageError);
}

}  // namespace surf
