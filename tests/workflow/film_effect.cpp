// SPDX-License-Identifier: GPL-3.0-or-later
#include "film_effect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surf/core/error.h"
#include "surf/io/sim/materials.h"
#include "surf/workflow/reconstruct_job.h"

namespace surf::workflow {
namespace {

FilmRequest request(const char* film) {
  FilmRequest r;
  r.film = io::find_material(film, "test");
  r.specimen = io::find_material("Si", "test");
  r.electrons = 8000;
  r.threads = 2;
  return r;
}

double at(const std::array<double, 3>& per_nm, double cosine) {
  return per_nm[0] + cosine * (per_nm[1] + cosine * per_nm[2]);
}

TEST(FilmEffect, AFilmOfTheSpecimensOwnMaterialChangesNothing) {
  const FilmEffect e = film_effect(request("Si"), {"SE", "BSE"});
  ASSERT_EQ(e.per_nm.size(), 2u);
  // Of 8000 primaries at seven tilts: 1 % of SE and 2 % of BSE per tilt, over 2 nm.
  for (const double cosine : {0.25, 0.6, 1.0}) {
    EXPECT_NEAR(at(e.per_nm[0], cosine), 0, 0.03);
    EXPECT_NEAR(at(e.per_nm[1], cosine), 0, 0.05);
  }
}

TEST(FilmEffect, GoldScattersMoreBackThanSiliconWhereTheBeamIsUpright) {
  const FilmEffect e = film_effect(request("Au"), {"SE", "BSE"});
  EXPECT_EQ(e.material, "Au");
  EXPECT_GT(at(e.per_nm[1], 1), 0.1);
}

TEST(FilmEffect, CanBeStopped) {
  CancelToken stop;
  stop.cancel();
  Watch watch;
  watch.cancel = &stop;
  EXPECT_THROW(film_effect(request("C"), {"SE"}, watch), Interrupted);
}

}  // namespace
}  // namespace surf::workflow
