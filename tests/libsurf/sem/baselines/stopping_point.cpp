// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/stopping_point.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sem/model/ring_shares.h"
#include "sem/model_checks.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double pitch = 2;

/// Stopping points in a bell about `center_nm`, in a few rings.
StoppingPointParameters bell(double center_nm = -4) {
  StoppingPointParameters p;
  p.ring_nm = 1.5, p.rings = 5;
  p.lowest_nm = -16, p.height_step_nm = 0.5, p.heights = 65;
  for (const bool reflected : {false, true}) {
    StoppingPointChannel c;
    c.name = reflected ? "BSE" : "SE";
    c.rule = reflected ? StoppingRule::reflected : StoppingRule::counted;
    for (int k = 0; k < p.rings; ++k)
      for (int i = 0; i < p.heights; ++i) {
        const double z = p.lowest_nm + i * p.height_step_nm - center_nm;
        const bool inside = i > 0 && i + 1 < p.heights;
        c.density_per_nm.push_back(inside ? 0.02 * (k + 1) * std::exp(-z * z / 18) : 0);
      }
    p.channels.push_back(c);
  }
  return p;
}

std::shared_ptr<const ImageModel> model(double center_nm = -4) {
  return make_stopping_point({.pixel_nm = pitch}, bell(center_nm));
}

TEST(RingPoints, SpreadEvenlyOverTheRing) {
  for (const int k : {0, 3, 40}) {
    const auto points = ring_points(k, 0.7, 2);
    double x = 0, y = 0, xx = 0;
    for (const RingPoint& p : points) {
      x += p.cosine, y += p.sine, xx += p.cosine * p.cosine;
      EXPECT_LE(std::abs(p.dx), ring_reach(k + 1, 0.7, 2));
    }
    EXPECT_NEAR(x, 0, 1e-9);
    EXPECT_NEAR(y, 0, 1e-9);
    EXPECT_NEAR(xx / static_cast<double>(points.size()), 0.5, 1e-9);
  }
  const auto points = ring_points(2, 4, 2);  // 8 to 12 nm: the pixel 5 to the right is whole in it
  double inside = 0;
  for (const RingPoint& p : points) inside += p.dx == 5 && p.dy == 0;
  EXPECT_NEAR(inside / static_cast<double>(points.size()), 4 / (3.14159265 * (144 - 64)), 3e-4);
}

TEST(StoppingPoint, GivesWhatStopsAboveAFlatSurface) {
  const StoppingPointParameters p = bell();
  double above = 0;
  for (int k = 0; k < p.rings; ++k)  // trapezes, from height 0 up
    for (int i = 32; i + 1 < p.heights; ++i) {
      const auto at = static_cast<std::size_t>(k * p.heights + i);
      above += 0.25 * (p.channels[0].density_per_nm[at] + p.channels[0].density_per_nm[at + 1]);
    }
  const HeightField flat = test::sampled(6, 5, pitch, [](int, int) { return 12.5; });
  for (const Edge edge : {Edge::mirror, Edge::flat, Edge::periodic}) {
    const ModelImages images = model()->predict(flat, {.edge = edge});
    for (const double v : images[0].data()) EXPECT_NEAR(v, above, 1e-12);
    for (const double v : images[1].data()) EXPECT_NEAR(v, above / (1 - above), 1e-12);
  }
}

TEST(StoppingPoint, SpikesGiveMoreThanPitsAndAllIsFinite) {
  const auto with = [](double z_nm) {
    return test::sampled(21, 21, pitch,
                         [&](int x, int y) { return x == 10 && y == 10 ? z_nm : 0.0; });
  };
  const ModelImages spike = model()->predict(with(1e4)), pit = model()->predict(with(-1e4));
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_GT(spike[c](10, 10), 2 * spike[c](0, 0));
    EXPECT_LT(pit[c](10, 10), 0.2 * pit[c](0, 0));
  }
  for (const double z : {1e4, -1e4, 1e60}) test::expect_finite(*model(), with(z), Edge::mirror);
}

TEST(StoppingPoint, GoesOnByItsTangentWhereAllComesBack) {
  // The whole bell lies above: I is far beyond 1/2.
  const ModelImages images =
      model(6)->predict(test::sampled(5, 5, pitch, [](int, int) { return 0.0; }));
  ASSERT_GT(images[0](2, 2), 0.5);
  EXPECT_DOUBLE_EQ(images[1](2, 2), 4 * images[0](2, 2) - 1);
}

TEST(StoppingPoint, HasExactDerivatives) {
  for (const Edge edge : {Edge::mirror, Edge::flat, Edge::periodic}) {
    const HeightField rough = test::rough_field(14, 11, pitch, 4);
    test::expect_exact_derivatives(*model(), rough, edge, 1e-4, 1e-5);
    test::expect_adjoint(*model(), rough, edge, 1e-12);
  }
}

TEST(StoppingPoint, TurnsWithTheSurfaceAndKnowsNoOrigin) {
  const HeightField rough = test::rough_field(15, 9, pitch, 4);
  HeightField other = rough;
  other.z_nm = test::turned(rough.z_nm);
  const ModelImages a = model()->predict(rough), b = model()->predict(other);
  for (std::size_t c = 0; c < 2; ++c)
    EXPECT_LT(test::largest_difference(test::turned(a[c]), b[c]), 1e-12);
  other = rough;
  for (double& z : other.z_nm.data()) z += 1000;
  EXPECT_LT(test::largest_difference(a[0], model()->predict(other)[0]), 1e-9);
  EXPECT_EQ(model()->predict(rough, {.threads = 1}), model()->predict(rough, {.threads = 3}));
}

TEST(StoppingPoint, RefusesWhatIsNoTable) {
  const ModelScope scope{.pixel_nm = pitch};
  EXPECT_THROW(make_stopping_point({}, bell()), InvalidInput);
  EXPECT_THROW(make_stopping_point({.pixel_nm = 0.01}, bell()), InvalidInput);
  StoppingPointParameters p = bell();
  p.channels[0].density_per_nm.pop_back();
  EXPECT_THROW(make_stopping_point(scope, p), InvalidInput);
  p = bell();
  p.channels[1].density_per_nm[70] = -1;
  EXPECT_THROW(make_stopping_point(scope, p), InvalidInput);
  p = bell();
  p.channels[1].density_per_nm[64] = 1;
  EXPECT_THROW(make_stopping_point(scope, p), InvalidInput);
  p = bell();
  p.ring_nm = 0;
  EXPECT_THROW(make_stopping_point(scope, p), InvalidInput);
  EXPECT_THROW(model()->predict(test::rough_field(8, 8, 3)), InvalidInput) << "another pitch";
}

TEST(StoppingPoint, IsWatched) { test::expect_watched(*model(), test::rough_field(30, 20)); }

}  // namespace
}  // namespace surf
