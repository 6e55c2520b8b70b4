// SPDX-License-Identifier: GPL-3.0-or-later
#include "first_calibration.h"

#include <gmock/gmock.h>

#include <cmath>

#include "surf/core/random.h"
#include "surf/sem/slope_model.h"

namespace surf::workflow {
namespace {

TEST(FirstCalibration, LeavesOutSaturatedPixelsOnly) {
  PlacedImage image;
  image.values = Grid<double>(64, 64);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values.data()[i] = static_cast<double>(i % 251);
  EXPECT_EQ(leave_out_saturated(image), 0);
  for (std::size_t i = 0; i < 600; ++i) image.values.data()[i] = 255;
  EXPECT_EQ(leave_out_saturated(image), 600);
  EXPECT_FALSE(image.is_valid(3, 0));
  EXPECT_TRUE(image.is_valid(3, 63));
  PlacedImage flat;
  flat.values = Grid<double>(8, 8, 4);
  EXPECT_EQ(leave_out_saturated(flat), 0);
}

/// A plain with bright stripes, and what a model makes of it that knows the stripes badly.
TEST(FirstCalibration, NoiseIsALineThatWallsDoNotBend) {
  const SlopeModelParameters form{SlopeForm::secant, 5, {5, 0.6}, {{"SE", 0.9, {}}}};
  const auto model = make_slope_model({}, form);
  HeightField surface;
  surface.z_nm = Grid<double>(160, 120);
  surface.pitch_x_nm = surface.pitch_y_nm = 5;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      surface.z_nm(x, y) = 20 * std::sin(0.1 * x) + (x % 40 < 20 ? 0 : 15);
  const Grid<double> truth = model->predict(surface).front();
  PlacedImage sem;
  sem.values = Grid<double>(160, 120);
  sem.pitch_x_nm = sem.pitch_y_nm = 5;
  const SemNoise noise{9, -300, 1};
  RandomStream random(3, 1, 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double mean = 100 * truth.data()[i] + 20;
    const double normal =
        std::sqrt(-2 * std::log(random.uniform())) * std::cos(6.283185307179586 * random.uniform());
    sem.values.data()[i] = mean + std::sqrt(noise.variance(mean)) * normal;
  }
  FirstCalibration first;
  first.gains = {100};
  first.offset = 20;
  first.noise = {0, 500, 1};
  HeightField rough = surface;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      rough.z_nm(x, y) -= x % 40 < 20 ? 0 : 3;  // walls 12 nm high, not 15
  EXPECT_TRUE(calibrate_again(sem, rough, *model, true, false, 1, first));
  std::vector<double> levels = sem.values.data();
  for (const double share : {0.2, 0.5, 0.8}) {
    std::ranges::nth_element(
        levels, levels.begin() + static_cast<std::ptrdiff_t>(share * double(levels.size())));
    const double level = levels[static_cast<std::size_t>(share * double(levels.size()))];
    EXPECT_GT(first.noise.variance(level), 0.8 * noise.variance(level)) << level;
    EXPECT_LT(first.noise.variance(level), 3.2 * noise.variance(level)) << level;
  }
  EXPECT_GT(first.noise.slope, 4);
}

}  // namespace
}  // namespace surf::workflow
