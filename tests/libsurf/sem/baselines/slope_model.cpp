// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/slope_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sem/model_checks.h"
#include "sem/model_surfaces.h"
#include "surf/core/error.h"

namespace {

using namespace surf;
using namespace surf::test;

constexpr SlopeForm forms[] = {SlopeForm::secant, SlopeForm::ikeuchi_exponential,
                               SlopeForm::ikeuchi_secant, SlopeForm::ikeuchi_mixed,
                               SlopeForm::table};

SlopeModelParameters slopes(SlopeForm form) {
  return {form,
          5,
          {5, 0.6},
          {{"SE",
            0.5,
            {1, 1.01, 1.05, 1.1, 1.2, 1.3, 1.5, 1.7, 2, 2.2, 2.3, 2.4, 2.4, 2.3, 2, 1.8, 1.6, 1.5}},
           {"BSE", 0.2, {0.3, 0.31, 0.35}}}};
}

double yield_at(SlopeForm form, double degrees, int channel = 0) {
  const double slope = std::tan(degrees * std::numbers::pi / 180);
  const HeightField plane = sampled(12, 12, 3, [&](int x, int) { return 3 * slope * x; });
  return make_slope_model({}, slopes(form))
      ->predict(plane, {.double_precision = true})[channel](6, 6);
}

TEST(SlopeModel, GivesEachFormsYieldOfTiltedPlanes) {
  const double degree = std::numbers::pi / 180;
  EXPECT_NEAR(yield_at(SlopeForm::secant, 60), 0.5 * 2, 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::secant, 60, 1), 0.2 * 2, 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::ikeuchi_exponential, 60), 0.5 * std::exp(0.5), 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::ikeuchi_secant, 50), 0.5 / std::cos(40 * degree), 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::ikeuchi_mixed, 60), 0.5 * 1.5, 1e-12);
  const double held = 0.5 * (0.5 + 0.5 / std::cos(70 * degree));
  EXPECT_NEAR(yield_at(SlopeForm::ikeuchi_mixed, 70), held, 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::ikeuchi_mixed, 80), held, 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::table, 0), 1, 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::table, 32), 1.5 + 0.4 * 0.2, 1e-12);
  EXPECT_NEAR(yield_at(SlopeForm::table, 88), 1.5 - 0.6 * 0.1, 1e-11);  // its last line goes on
  EXPECT_NEAR(yield_at(SlopeForm::table, 15, 1), 0.39, 1e-12);
}

TEST(SlopeModel, LinearizationIsExact) {
  for (const SlopeForm form : forms) {
    const auto model = make_slope_model({}, slopes(form));
    for (const Edge edge : {Edge::mirror, Edge::flat, Edge::periodic}) {
      SCOPED_TRACE(static_cast<int>(form));
      // Small steps: a table's kinks lie between few pixels' two sides.
      expect_exact_derivatives(*model, rough_field(23, 31), edge, 1e-6, 1e-5);
      expect_exact_derivatives(*model, rough_field(23, 31, 2, 0.3), edge, 1e-6, 1e-5);
      expect_adjoint(*model, rough_field(40, 700), edge, 1e-12);
      expect_adjoint(*model, rough_field(2, 2), edge, 1e-12);
    }
  }
}

TEST(SlopeModel, IsFiniteOnFlatAndSteepSurfaces) {
  const HeightField flat = sampled(9, 9, 2, [](int, int) { return 3.0; });
  for (const SlopeForm form : forms) {
    const auto model = make_slope_model({}, slopes(form));
    expect_finite(*model, flat, Edge::mirror);
    expect_exact_derivatives(*model, flat, Edge::mirror, 1e-4, 1e-6);
    for (const double relief : {1e-300, 1e-30, 1e6, 1e10})
      expect_finite(*model, rough_field(9, 14, 2, relief), Edge::flat);
  }
}

TEST(SlopeModel, TakesTheMeanOfBothSidesAtAKink) {
  // The plane lies at 45 degrees, where the table turns: 1 to 1.5 to 1.75.
  SlopeModelParameters p = slopes(SlopeForm::table);
  p.table_step_deg = 45;
  p.channels = {{"SE", 1, {1, 1.5, 1.75}}};
  const HeightField plane = sampled(8, 8, 1, [](int x, int) { return double(x); });
  const auto linear =
      make_slope_model({}, p)->linearize(plane, {.edge = Edge::flat, .double_precision = true});
  const ModelImages change =
      linear->change(sampled(8, 8, 1, [](int x, int) { return double(x); }).z_nm);
  const double per_slope = 0.5 / (std::numbers::pi / 4);
  EXPECT_GT(change[0](4, 4), 0.25 * per_slope - 1e-9);
  EXPECT_LT(change[0](4, 4), 0.5 * per_slope + 1e-9);
}

TEST(SlopeModel, RefusesBadParameters) {
  const auto refused = [](SlopeForm form, auto change) {
    SlopeModelParameters p = slopes(form);
    change(p);
    EXPECT_THROW(make_slope_model({}, p), InvalidInput);
  };
  refused(SlopeForm::secant, [](auto& p) { p.channels.clear(); });
  refused(SlopeForm::secant, [](auto& p) { p.channels[0].flat_yield = 0; });
  refused(SlopeForm::secant, [](auto& p) { p.channels[0].flat_yield = std::nan(""); });
  refused(SlopeForm::secant, [](auto& p) { p.facet.size = 4; });
  refused(SlopeForm::table, [](auto& p) { p.channels[0].yields = {1}; });
  refused(SlopeForm::table, [](auto& p) { p.channels[0].yields[2] = std::nan(""); });
  refused(SlopeForm::table, [](auto& p) { p.table_step_deg = 6; });
  refused(SlopeForm::table, [](auto& p) { p.table_step_deg = 0; });
}

TEST(SlopeModel, IsWatched) {
  expect_watched(*make_slope_model({}, slopes(SlopeForm::table)), rough_field(150, 700));
}

}  // namespace
