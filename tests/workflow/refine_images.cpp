// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine_images.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "profile_signals.h"
#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/profile/feature_shape.h"
#include "surf/refinement/mesh_modes.h"
#include "surf/workflow/libraries.h"
#include "temporary_folder.h"

namespace surf::workflow {
namespace {

constexpr int columns = 48, rows = 8, window = 4;  // pixels
constexpr double pixel_nm = 2, tilt_deg = 15, energy_ev = 300;

/// A line seen from one side.
RefineJob seen_from_one_side() {
  RefineJob job;
  PlacedImage image;
  image.pitch_x_nm = image.pitch_y_nm = pixel_nm;
  image.origin_x_nm = -0.5 * (columns - 1) * pixel_nm;
  image.origin_y_nm = -0.5 * (rows - 1) * pixel_nm;
  image.values = Grid<double>(columns, rows, 0);
  job.images = {{image, {}, {}}};
  job.tilts_deg = {tilt_deg};
  job.tilt_error_deg = 0;
  job.material = io::find_material("Si", "test");
  job.energy_ev = energy_ev;
  return job;
}

/// Sums over `window` columns, and their variances.
struct Windows {
  std::array<double, columns / window> sum{}, variance{};
};

/// Each electron by itself, without a library.
Windows long_simulation(const TriangleMesh& mesh, std::uint64_t seed) {
  mc::Specimen specimen;
  specimen.materials = {io::find_material("Si", "test")};
  specimen.bodies.push_back({"line", mesh, 0});
  mc::Beam beam;
  beam.energy_ev = energy_ev, beam.tilt_deg = tilt_deg;
  mc::Scan scan;
  scan.width = columns, scan.height = rows;
  scan.pixel_x_nm = scan.pixel_y_nm = pixel_nm;
  mc::SimulationOptions options;
  options.method = mc::Method::direct;
  options.budget = mc::ElectronsPerPixel{1200};
  options.seed = seed;
  const mc::SimulationResult done = mc::simulate(mc::Scene(specimen, beam, scan), options, {});
  Windows out;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const auto yield = done.yield(0, x, y);
      const auto k = static_cast<std::size_t>(x / window);
      out.sum[k] += yield.mean, out.variance[k] += yield.standard_error * yield.standard_error;
    }
  return out;
}

TEST(RefineImages, EffectsAreThoseThatLongSimulationsDifferBy) {
  const RefineJob job = seen_from_one_side();
  const test::TemporaryFolder cascades;
  CachedLibraries cached(cascades.path());
  const TriangleMesh line = feature_mesh({FeatureKind::line, 40, 0, {30, 95, 1, 1}}, 300);
  std::vector<MeshMode> modes =
      smooth_modes(line, {{-25, -10, 0}, {25, 10, 30}}, SmoothKind::walls);
  modes.resize(3);  // along x: the line leans, grows wider, tapers

  constexpr std::size_t repeats = 10;
  std::array<Windows, 3> effects;
  std::array<std::array<Windows, 3>, repeats> each;
  for (std::size_t n = 0; n < repeats; ++n) {
    std::vector<RefinedView> views(1);
    views[0].measured = Grid<double>(columns, rows, 0);
    std::int64_t counted = 0;
    SharedLibraries libraries(cached, job.threads);  // one for all images, as in a refinement
    const RefineImages images(job, libraries);
    images.add_effects(line, modes, {0, 0, 0}, {{}}, 80, 1000 + 10 * n, {}, views, counted);
    EXPECT_GT(counted, 0);
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const ModeEffect& e = views[0].effects[m];
      Windows& once = each[n][m];
      for (std::size_t i = 0; i < e.pixels.size(); ++i)
        once.sum[e.pixels[i] % columns / window] += 0.5 * (e.first[i] + e.second[i]);
      for (std::size_t k = 0; k < once.sum.size(); ++k)
        effects[m].sum[k] += once.sum[k] / repeats,
            effects[m].variance[k] += once.sum[k] * once.sum[k];
    }
  }

  constexpr double step_nm = 2;  // of the effects, too
  double chi_squared = 0, squares = 0, others_variance = 0;
  std::array<double, repeats> products{};
  for (std::size_t m = 0; m < modes.size(); ++m) {
    const auto moved_by = [&](double amplitude, std::uint64_t seed) {
      std::vector<double> amplitudes(modes.size(), 0);
      amplitudes[m] = amplitude;
      return long_simulation(moved(line, modes, amplitudes), seed);
    };
    const Windows before = moved_by(-step_nm, 2 * m + 1), after = moved_by(step_nm, 2 * m + 2);
    for (std::size_t k = 0; k < before.sum.size(); ++k) {
      const double effect = effects[m].sum[k],
                   wanted = (after.sum[k] - before.sum[k]) / (2 * step_nm),
                   own = (effects[m].variance[k] - repeats * effect * effect) /
                         (repeats * (repeats - 1.0)),
                   others = (before.variance[k] + after.variance[k]) / (4 * step_nm * step_nm);
      chi_squared += (effect - wanted) * (effect - wanted) / (own + others);
      for (std::size_t n = 0; n < repeats; ++n) products[n] += each[n][m].sum[k] * wanted;
      squares += wanted * wanted - others, others_variance += wanted * wanted * others;
    }
  }
  EXPECT_NEAR(chi_squared / static_cast<double>(modes.size() * effects[0].sum.size()), 1, 0.7);
  // What a library makes of chance is shared by all windows: the repeats tell it, windows do not.
  double size = 0, spread = 0;
  for (const double p : products) size += p / squares / repeats;
  for (const double p : products) spread += std::pow(p / squares - size, 2);
  const double error =
      std::sqrt(spread / (repeats * (repeats - 1.0)) + others_variance / (squares * squares));
  EXPECT_LT(error, 0.025);
  EXPECT_NEAR(size, 1, 4 * error);
}

// A roof over level ground, seen from above: its underside is not, nor is the ground below.
TEST(RefineImages, WhatIsHiddenIsNotInSight) {
  TriangleMesh mesh;
  constexpr int side = 11;
  for (const double z : {0.0, 20.0})
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) mesh.vertices_nm.push_back({10.0 * x, 10.0 * y, z});
  const auto add = [&](std::uint32_t first, int from, int to) {
    for (int y = from; y < to; ++y)
      for (int x = from; x < to; ++x) {
        const auto a = first + static_cast<std::uint32_t>(y * side + x);
        mesh.triangles.push_back({a, a + 1, a + side + 1});
        mesh.triangles.push_back({a, a + side + 1, a + side});
      }
  };
  add(0, 0, side - 1);
  add(side * side, 2, 8);
  Grid<Vec3> seen(100, 100);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const bool roof = x >= 20 && x < 80 && y >= 20 && y < 80;
      seen(x, y) = {x + 0.5, y + 0.5, roof ? 20.0 : 0.0};
    }
  seen(0, 0).x = std::nan("");  // a pixel that sees nothing
  const std::vector<bool> in_sight = vertices_in_sight(mesh, seen);
  const auto at = [&](int x, int y, bool roof) {
    return static_cast<bool>(
        in_sight[static_cast<std::size_t>((roof ? side * side : 0) + y * side + x)]);
  };
  EXPECT_TRUE(at(1, 1, false));
  EXPECT_TRUE(at(5, 5, true));
  EXPECT_FALSE(at(5, 5, false));  // two triangles under the roof's edge and more
  EXPECT_FALSE(at(0, 0, true));   // of no triangle
}

}  // namespace
}  // namespace surf::workflow
