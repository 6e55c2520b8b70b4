// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/film_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "sem/model_checks.h"
#include "surf/core/error.h"
#include "surf/sem/slope_model.h"

namespace surf {
namespace {

std::shared_ptr<const ImageModel> plain_model() {
  return make_slope_model({},
                          {SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}, {"BSE", 0.3, {}}}});
}

const FilmEffect film{"C", {{0.1, -0.6, 0.2}, {-0.2, 0.1, 0.05}}};

HeightField waves() {
  HeightField f{{5, 5, 0, 0}, Grid<double>(13, 9)};
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 13; ++x)
      f.z_nm(x, y) = 0.9 * f.x_nm(x) + 8 * std::sin(0.07 * f.x_nm(x)) * std::cos(0.05 * f.y_nm(y));
  return f;
}

TEST(FilmModel, ChangesAYieldByTheSlope) {
  const FilmModel model(plain_model(), film);
  EXPECT_THAT(model.channels(), testing::ElementsAre("SE", "BSE", "SE.film", "BSE.film"));
  HeightField plane{{5, 5, 0, 0}, Grid<double>(7, 7)};
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 7; ++x) plane.z_nm(x, y) = std::sqrt(3) * 5 * x;  // 60 degrees
  const ModelImages images = model.predict(plane);
  EXPECT_NEAR(images[2](3, 3), images[0](3, 3) * (0.1 - 0.6 * 0.5 + 0.2 * 0.25), 1e-9);
  EXPECT_NEAR(images[3](3, 3), images[1](3, 3) * (-0.2 + 0.1 * 0.5 + 0.05 * 0.25), 1e-9);
}

TEST(FilmModel, HasExactDerivatives) {
  const FilmModel model(plain_model(), film);
  for (const Edge edge : {Edge::mirror, Edge::flat}) {
    test::expect_exact_derivatives(model, waves(), edge, 1e-4, 1e-5);
    test::expect_adjoint(model, waves(), edge, 1e-12);
  }
}

TEST(FilmModel, RefusesAnEffectThatIsNoneOfTheModels) {
  EXPECT_THROW(FilmModel(plain_model(), {"C", {{0, 0, 0}}}), InvalidInput);
  FilmEffect bad = film;
  bad.per_nm[1][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FilmModel(plain_model(), bad), InvalidInput);
  const FilmModel model(plain_model(), film);
  EXPECT_THROW(model.linearize(waves())->gradient(ModelImages(2, Grid<double>(13, 9))),
               InvalidInput);
}

TEST(FilmModel, FitsItsNumbersByWeight) {
  std::vector<FilmPoint> points;
  for (const double c : {0.2, 0.5, 0.8, 1.0})
    points.push_back({c, 0.3 - 0.2 * c + 0.1 * c * c, 0.01});
  points.push_back({0.6, 100, 1e6});  // is not known
  const auto fit = fit_film_effect(points);
  EXPECT_NEAR(fit[0], 0.3, 1e-6);
  EXPECT_NEAR(fit[1], -0.2, 1e-6);
  EXPECT_NEAR(fit[2], 0.1, 1e-6);
  points.resize(2);
  EXPECT_THROW(fit_film_effect(points), InvalidInput);
  EXPECT_THROW(fit_film_effect({{0.1, 1, 1}, {0.5, 1, 0}, {1, 1, 1}}), InvalidInput);
}

}  // namespace
}  // namespace surf
