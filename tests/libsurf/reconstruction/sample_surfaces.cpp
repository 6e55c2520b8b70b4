// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/reconstruction/sample_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "surf/core/error.h"
#include "surf/sem/surface_range.h"

namespace surf {
namespace {

/// A 4560 x 1720 nm view about (0, 0).
HeightField view(const SampleSurface& surface, double pitch_nm, int threads = 0) {
  HeightField field;
  field.z_nm = Grid<double>(static_cast<int>(4560 / pitch_nm), static_cast<int>(1720 / pitch_nm));
  field.pitch_x_nm = field.pitch_y_nm = pitch_nm;
  field.origin_x_nm = -2280, field.origin_y_nm = -860;
  sample_heights(surface, {}, field, threads);
  return field;
}

TEST(SampleSurfaces, AreFiveAndFoundByName) {
  EXPECT_EQ(sample_surfaces().size(), 5u);
  std::set<std::string> names;
  for (const SampleSurface& s : sample_surfaces()) {
    EXPECT_TRUE(names.insert(s.name).second);
    EXPECT_EQ(&find_sample_surface(s.name), &s);
  }
  try {
    find_sample_surface("thick");
    FAIL() << "nothing was refused";
  } catch (const UsageError& error) {
    EXPECT_NE(error.remedy().find("nist0523-thick"), std::string::npos);
  }
}

TEST(SampleSurfaces, AreSteepHighAndSmooth) {
  constexpr double pitch = 10;
  for (const SampleSurface& s : sample_surfaces()) {
    SCOPED_TRACE(s.name);
    const HeightField field = view(s, pitch);
    const auto [low, high] =
        std::minmax_element(field.z_nm.data().begin(), field.z_nm.data().end());
    EXPECT_GT(*high - *low, 85);
    EXPECT_LT(*high - *low, 220);
    const SurfaceRange range = surface_range(field);
    EXPECT_GT(range.slope_deg_max, s.name == "terrain" ? 45 : 60);
    EXPECT_LT(range.slope_deg_max, 73);
    // No walls between samples: what lies in between is the mean of its neighbours, as far as a
    // curved edge allows.
    double worst = 0;
    for (int y = 0; y < field.z_nm.height(); y += 4)
      for (int x = 1; x < field.z_nm.width(); ++x) {
        const double between = s.z_nm(field.x_nm(x) - 0.5 * pitch, field.y_nm(y));
        worst =
            std::max(worst, std::abs(between - 0.5 * (field.z_nm(x, y) + field.z_nm(x - 1, y))));
      }
    EXPECT_LT(worst, 4);
  }
}

TEST(SampleSurfaces, GoOnAroundTheView) {
  for (const SampleSurface& s : sample_surfaces()) {
    SCOPED_TRACE(s.name);
    HeightField field;
    field.z_nm = Grid<double>(100, 40);
    field.pitch_x_nm = field.pitch_y_nm = 20;
    for (const auto& [x, y] :
         {std::pair{-4000.0, -400.0}, {2400.0, -400.0}, {-1000.0, -2500.0}, {-1000.0, 1500.0}}) {
      field.origin_x_nm = x, field.origin_y_nm = y;
      sample_heights(s, {}, field);
      const auto [low, high] =
          std::minmax_element(field.z_nm.data().begin(), field.z_nm.data().end());
      EXPECT_GT(*high - *low, 50);
    }
  }
}

TEST(SampleSurfaces, DoNotDependOnThreads) {
  for (const SampleSurface& s : sample_surfaces())
    EXPECT_EQ(view(s, 40, 1).z_nm, view(s, 40, 3).z_nm);
}

TEST(SampleSurfaces, AreSampledThroughAMap) {
  const SampleSurface& s = sample_surfaces().front();
  const Affine map = make_affine({0.4, 1.1, 0.9, 0.05, 120, -70});
  HeightField field;
  field.z_nm = Grid<double>(7, 5);
  field.pitch_x_nm = 30, field.pitch_y_nm = 20;
  field.origin_x_nm = 11;
  sample_heights(s, map, field);
  const Point2 p = map({11 + 3 * 30, 2 * 20});
  EXPECT_EQ(field.z_nm(3, 2), s.z_nm(p.x, p.y));
  field.pitch_x_nm = 0;
  EXPECT_THROW(sample_heights(s, map, field), InvalidInput);
}

}  // namespace
}  // namespace surf
