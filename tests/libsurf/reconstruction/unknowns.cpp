// SPDX-License-Identifier: GPL-3.0-or-later
// What a reconstruction may be told to find besides the surface.
#include <gtest/gtest.h>

#include <cmath>

#include "core/cubic_sample.h"
#include "reconstruction/spot_blur.h"
#include "small_scene.h"
#include "surf/core/error.h"

namespace surf {
namespace {

using test::quick;

/// A scan whose first and last rows are displaced by 3 SEM pixels along both axes.
test::SmallScene drifted() {
  test::SmallScene scene(5, 64, 48, 0.5);
  const Grid<double> straight = scene.afm.image.z_nm;
  const int n = straight.width(), m = straight.height();
  const Affine& map = scene.sem.sem_to_afm;
  for (int y = 0; y < m; ++y) {
    const double t = 2.0 * y / (m - 1) - 1, nm = 30 * t * t;
    const double by_x = (map.xx + map.xy) * nm / 20, by_y = (map.yx + map.yy) * nm / 20;
    for (int x = 0; x < n; ++x)
      scene.afm.image.z_nm(x, y) =
          CubicSample(std::clamp(x + by_x, 0.0, n - 1.0), std::clamp(y + by_y, 0.0, m - 1.0), n, m)
              .value(straight);
  }
  return scene;
}

TEST(Unknowns, AScanThatDriftsIsPutStraight) {
  const test::SmallScene scene = drifted();
  ReconstructionOptions o = quick();
  const Reconstruction steady = reconstruct(&scene.afm, &scene.sem, o);
  o.refine_drift = true;
  const Reconstruction found = reconstruct(&scene.afm, &scene.sem, o);
  EXPECT_LT(scene.rms_error(found.surface), 0.9 * scene.rms_error(steady.surface));
  EXPECT_EQ(steady.scan_drift_px.x, 0);
  // The SEM image shows three quarters of the scan's rows, which bend by half as much.
  EXPECT_GT(found.scan_drift_px.x, 0.8);
  EXPECT_GT(found.scan_drift_px.y, 0.8);
}

TEST(Unknowns, ASpotThatIsWiderThanTheModelsIsFound) {
  test::SmallScene scene(5, 64, 48, 0.5);
  const Grid<double> sharp = scene.sem.model->predict(scene.truth)[0];
  const Grid<double> wide = reconstruction::blurred(sharp, 0.8);
  for (std::size_t i = 0; i < wide.size(); ++i)
    scene.sem.image.values.data()[i] += 100 * (wide.data()[i] - sharp.data()[i]);
  ReconstructionOptions o = quick();
  EXPECT_EQ(reconstruct(&scene.afm, &scene.sem, o).blur_px2, 0);
  o.refine_spot = true;
  EXPECT_NEAR(reconstruct(&scene.afm, &scene.sem, o).blur_px2, 0.8, 0.25);
}

TEST(Unknowns, AFilmThatChangesWallsMoreThanPlateausIsFound) {
  test::SmallScene scene(5, 64, 48, 0.5);
  const FilmEffect film{"C", {{0.02, 0.1, -0.2}}};
  const ModelImages images = FilmModel(scene.sem.model, film).predict(scene.truth);
  for (std::size_t i = 0; i < images[1].size(); ++i)
    scene.sem.image.values.data()[i] += 100 * 2 * images[1].data()[i];
  ReconstructionOptions o = quick();
  o.refine_calibration = false;  // another gain and offset would do nearly the same
  const Reconstruction without = reconstruct(&scene.afm, &scene.sem, o);
  EXPECT_EQ(without.film_nm, 0);
  scene.sem.film = film;
  const Reconstruction with = reconstruct(&scene.afm, &scene.sem, o);
  EXPECT_NEAR(with.film_nm, 2, 0.3);
  EXPECT_LT(scene.rms_error(with.surface), scene.rms_error(without.surface));
}

/// Rows that are displaced by up to a pixel.
TEST(Unknowns, DisplacedLinesOfTheImageAreFoundRowByRow) {
  test::SmallScene scene(5, 64, 48, 0.5);
  Grid<double>& image = scene.sem.image.values;
  const Grid<double> straight = image;
  const Grid<double> by = simulate_noise({0, 0.5}, image.height(), 1, 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = CubicSample(std::clamp(x - by(y, 0), 0.0, image.width() - 1.0), y,
                                image.width(), image.height())
                        .value(straight);
  scene.sem.discrepancy = usual_discrepancy(scene.sem.image, 0.03);
  scene.sem.row_jitter = line_jitter(scene.sem.image, 0.7);
  const Reconstruction r = reconstruct(&scene.afm, &scene.sem, quick());
  ASSERT_EQ(r.sem_row_jitter.size(), 48u);
  double together = 0, found = 0, truth = 0;
  for (int y = 14; y < 34; ++y) {  // rows that cross the block
    const double size = r.sem_row_jitter[static_cast<std::size_t>(y)];
    together += size * by(y, 0), found += size * size, truth += by(y, 0) * by(y, 0);
  }
  EXPECT_GT(together / std::sqrt(found * truth), 0.9);
}

TEST(Unknowns, TheJitterOfRowsMustFitTheImage) {
  test::SmallScene scene;
  scene.sem.row_jitter = Grid<double>(3, 3);
  EXPECT_THROW(reconstruct(&scene.afm, &scene.sem, quick()), InvalidInput);
}

}  // namespace
}  // namespace surf
