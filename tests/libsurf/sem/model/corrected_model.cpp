// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/sem/corrected_model.h"

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
  return make_slope_model({}, {SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}}});
}

HeightField field(int width, int height, double origin_x_nm, double origin_y_nm) {
  HeightField f{{5, 5, origin_x_nm, origin_y_nm}, Grid<double>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      f.z_nm(x, y) = 6 * std::sin(0.07 * f.x_nm(x)) * std::cos(0.05 * f.y_nm(y));
  return f;
}

/// Different everywhere.
Grid<double> off() {
  Grid<double> image(8, 6);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.data()[i] = 0.01 * static_cast<double>(i + 1);
  return image;
}

TEST(CorrectedModel, AddsWhatItIsOffByWhereThatWasSeen) {
  const auto model = plain_model();
  const CorrectedModel corrected(model, {off()}, {{5, 5}, 100, 50});
  const HeightField same = field(8, 6, 100, 50), wider = field(12, 9, 90, 45),
                    part = field(6, 4, 110, 55);
  const auto added = [&](const HeightField& f, int x, int y) {
    return corrected.predict(f)[0](x, y) - model->predict(f)[0](x, y);
  };
  EXPECT_NEAR(added(same, 3, 2), off()(3, 2), 1e-12);
  EXPECT_NEAR(added(wider, 5, 3), off()(3, 2), 1e-12);
  EXPECT_EQ(added(wider, 1, 0), 0);
  EXPECT_EQ(added(wider, 11, 8), 0);
  EXPECT_NEAR(added(part, 1, 1), off()(3, 2), 1e-12);
}

TEST(CorrectedModel, ChangesAsTheModelDoes) {
  const auto model = plain_model();
  const CorrectedModel corrected(model, {off()}, {{5, 5}, 100, 50});
  const HeightField f = field(8, 6, 100, 50);
  const auto linear = corrected.linearize(f), plain = model->linearize(f);
  EXPECT_EQ(linear->images()[0], corrected.predict(f)[0]);
  const ModelImages weights = test::random_weights(f, 1);
  EXPECT_EQ(linear->gradient(weights), plain->gradient(weights));
  EXPECT_EQ(linear->change(weights[0]), plain->change(weights[0]));
}

TEST(CorrectedModel, RefusesWhatIsNoCorrection) {
  EXPECT_THROW(CorrectedModel(plain_model(), {}, {}), InvalidInput);
  Grid<double> bad = off();
  bad(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CorrectedModel(plain_model(), {bad}, {}), InvalidInput);
}

}  // namespace
}  // namespace surf
