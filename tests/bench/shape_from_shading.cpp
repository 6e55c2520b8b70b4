// SPDX-License-Identifier: GPL-3.0-or-later
#include "baselines/shape_from_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "baselines/shape_from_shading_horn.h"
#include "baselines/shape_from_shading_leclerc_bobick.h"

namespace surf::bench {
namespace {

constexpr int side = 40;
constexpr double pitch_nm = 10, height_nm = 60, width_nm = 60;

/// A hill of slopes up to 0.6 in the middle, less its mean.
Grid<double> hill(double share = 1) {
  Grid<double> z(side, side);
  double sum = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double r2 = std::pow((x - 19.3) * pitch_nm, 2) + std::pow((y - 20.6) * pitch_nm, 2);
      sum += z(x, y) = share * height_nm * std::exp(-r2 / (2 * width_nm * width_nm));
    }
  for (double& v : z.data()) v -= sum / static_cast<double>(z.size());
  return z;
}

/// The image of heights by central differences.
Grid<double> shaded(const Grid<double>& z, const ReflectanceMap& map) {
  Grid<double> out(side, side, 1);
  for (int y = 1; y + 1 < side; ++y)
    for (int x = 1; x + 1 < side; ++x)
      out(x, y) = map.at((z(x + 1, y) - z(x - 1, y)) / (2 * pitch_nm),
                         (z(x, y + 1) - z(x, y - 1)) / (2 * pitch_nm))
                      .r;
  return out;
}

ShadedImage image_of_hill() {
  const ReflectanceMap map =
      reflectance_of({.form = SlopeForm::secant, .channels = {{"SE", 1, {}}}}, {900.0}, 120);
  return {shaded(hill(), map), pitch_nm, map};
}

double rms(const Grid<double>& a, const Grid<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a.data()[i] - b.data()[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// A weight that is next to nothing at the end, as the image has no noise.
Grid<double> by_horn(const ShadedImage& image, const Grid<double>& start, int levels) {
  return shape_by_horn(image, start,
                       {.levels = levels,
                        .first_smoothness = 0.1,
                        .last_smoothness = 1e-3,
                        .integrability = 0.03,
                        .sweeps = 300,
                        .tolerance = 1e-6});
}
Grid<double> by_leclerc_bobick(const ShadedImage& image, const Grid<double>& start, int levels) {
  return shape_by_leclerc_bobick(image, start,
                                 {.levels = levels,
                                  .first_lambda = 0.1,
                                  .last_lambda = 1e-4,
                                  .iterations = 100,
                                  .tolerance = 1e-6});
}

using Method = Grid<double> (*)(const ShadedImage&, const Grid<double>&, int);
struct Case {
  std::string name;
  Method method;
  int levels;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
class ShapeFromShading : public testing::TestWithParam<Case> {};

TEST_P(ShapeFromShading, FindsAHillFromHalfOfIt) {
  const ShadedImage image = image_of_hill();
  const Grid<double> start = hill(0.5), found = GetParam().method(image, start, GetParam().levels);
  EXPECT_LT(rms(found, hill()), 0.15 * rms(start, hill()));
  const Grid<double> flat(side, side, 1);
  EXPECT_LT(rms(shaded(found, image.reflectance), image.relative),
            0.05 * rms(flat, image.relative));
}

TEST_P(ShapeFromShading, FindsAPitFromHalfAPit) {
  const Grid<double> found = GetParam().method(image_of_hill(), hill(-0.5), GetParam().levels);
  EXPECT_LT(rms(found, hill(-1)), 0.15 * rms(hill(-0.5), hill(-1)));
}

TEST_P(ShapeFromShading, LeavesTheConstantAsItIs) {
  Grid<double> start = hill(0.5);
  for (double& z : start.data()) z += 1000;
  const Grid<double> found = GetParam().method(image_of_hill(), start, GetParam().levels);
  double sum = 0;
  for (const double z : found.data()) sum += z / static_cast<double>(found.size());
  EXPECT_NEAR(sum, 1000, 1e-6);
}

TEST_P(ShapeFromShading, CannotLeaveALevelPlane) {
  const Grid<double> level(side, side, 7);
  EXPECT_LT(rms(GetParam().method(image_of_hill(), level, GetParam().levels), level), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Methods, ShapeFromShading,
                         testing::Values(Case{"Horn", by_horn, 1},
                                         Case{"HornCoarseToFine", by_horn, 2},
                                         Case{"LeclercBobick", by_leclerc_bobick, 1},
                                         Case{"LeclercBobickCoarseToFine", by_leclerc_bobick, 2}),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace surf::bench
