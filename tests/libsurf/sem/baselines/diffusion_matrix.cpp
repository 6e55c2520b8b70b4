// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/diffusion_matrix.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sem/model_checks.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"

namespace surf {
namespace {

constexpr double pitch = 2;

/// A bell of flux about the entry, wherever `moments` say it goes.
DiffusionMatrixParameters bell(const std::vector<std::array<double, diffusion_moments>>& channels) {
  DiffusionMatrixParameters p;
  p.ring_nm = 1.5, p.rings = 5;
  p.lowest_nm = -16, p.height_step_nm = 1, p.heights = 33;
  const char* names[] = {"SE", "BSE"};
  for (std::size_t n = 0; n < channels.size(); ++n) {
    DiffusionMatrixChannel c{names[n], {}};
    for (int k = 0; k < p.rings; ++k)
      for (int i = 0; i < p.heights; ++i) {
        const double z = p.lowest_nm + i, size = std::exp(-z * z / 50) / (k + 1);
        for (const double m : channels[n]) c.moments_per_nm2.push_back(m * size);
      }
    p.channels.push_back(c);
  }
  return p;
}

const std::array<double, diffusion_moments> isotropic{0, 0, 1.0 / 3, 1.0 / 3, 1.0 / 3, 0};
const std::array<double, diffusion_moments> upward{0.2, 0.7, 0.3, 0.2, 0.5, 0.1};

std::shared_ptr<const ImageModel> model() {
  return make_diffusion_matrix({.pixel_nm = pitch}, bell({isotropic, upward}));
}

TEST(DiffusionMatrix, AddsUpTheFluxThroughAFlatSurface) {
  // Within the B-spline at height 0: 1/8, 3/4, 1/8 of the heights around.
  const double smooth = 0.75 + 0.25 * std::exp(-1.0 / 50);
  double rings = 0;
  for (int k = 0; k < 5; ++k) rings += std::numbers::pi * (2 * k + 1) * 1.5 * 1.5 / (k + 1);
  const HeightField flat = test::sampled(6, 5, pitch, [](int, int) { return -3.0; });
  const ModelImages images = model()->predict(flat);
  // Of directions that are all alike half go out, with a mean cosine of 1/2.
  for (const double v : images[0].data()) EXPECT_NEAR(v, 0.25 * smooth * rings, 1e-12);
  const double out = 0.5 * (0.7 + 3.0 / 16 + 15.0 / 16 * 0.5);
  for (const double v : images[1].data()) EXPECT_NEAR(v, out * smooth * rings, 1e-12);
}

TEST(DiffusionMatrix, GrowsWithTheAreaOfFacets) {
  const auto tilted = [](double slope) {
    return test::sampled(30, 30, pitch, [&](int x, int) { return slope * pitch * x; });
  };
  const double level = model()->predict(tilted(0))[0](15, 15),
               steep = model()->predict(tilted(0.75))[0](15, 15);
  EXPECT_GT(steep / level, 1.1);
  EXPECT_LT(steep / level, 1.25) << "the area grows by 1.25, the flux falls off";
}

TEST(DiffusionMatrix, HasExactDerivatives) {
  for (const Edge edge : {Edge::mirror, Edge::flat, Edge::periodic}) {
    const HeightField rough = test::rough_field(12, 10, pitch, 4);
    test::expect_exact_derivatives(*model(), rough, edge, 1e-4, 1e-5);
    test::expect_adjoint(*model(), rough, edge, 1e-12);
  }
}

TEST(DiffusionMatrix, TurnsWithTheSurfaceAndKnowsNoOrigin) {
  const HeightField rough = test::rough_field(15, 9, pitch, 4);
  HeightField other = rough;
  other.z_nm = test::turned(rough.z_nm);
  const ModelImages a = model()->predict(rough), b = model()->predict(other);
  for (std::size_t c = 0; c < 2; ++c)
    EXPECT_LT(test::largest_difference(test::turned(a[c]), b[c]), 1e-12);
  other = rough;
  for (double& z : other.z_nm.data()) z += 1000;
  EXPECT_LT(test::largest_difference(a[1], model()->predict(other)[1]), 1e-9);
  EXPECT_EQ(model()->predict(rough, {.threads = 1}), model()->predict(rough, {.threads = 3}));
}

TEST(DiffusionMatrix, StaysFiniteOnWalls) {
  const HeightField walls = test::sampled(12, 12, pitch, [](int x, int y) {
    return x > 5 ? 1e5 : y > 5 ? -1e5 : 0.0;
  });
  test::expect_finite(*model(), walls, Edge::mirror);
  test::expect_finite(*model(), test::rough_field(4, 4, pitch, 50), Edge::periodic);
}

TEST(DiffusionMatrix, RefusesWhatIsNoTable) {
  const ModelScope scope{.pixel_nm = pitch};
  EXPECT_THROW(make_diffusion_matrix({}, bell({upward})), InvalidInput);
  EXPECT_THROW(make_diffusion_matrix({.pixel_nm = 0.1}, bell({upward})), InvalidInput);
  DiffusionMatrixParameters p = bell({upward});
  p.channels[0].moments_per_nm2.pop_back();
  EXPECT_THROW(make_diffusion_matrix(scope, p), InvalidInput);
  p = bell({upward});
  p.channels[0].moments_per_nm2[5] = NAN;
  EXPECT_THROW(make_diffusion_matrix(scope, p), InvalidInput);
  p = bell({upward});
  p.channels.clear();
  EXPECT_THROW(make_diffusion_matrix(scope, p), InvalidInput);
}

TEST(DiffusionMatrix, IsWatched) { test::expect_watched(*model(), test::rough_field(30, 20)); }

}  // namespace
}  // namespace surf
