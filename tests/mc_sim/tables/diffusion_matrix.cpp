// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/tables/cascade_tables.h"

#include "cascades/walk_cascade.h"
#include "replay/replay_test.h"
#include "surf/mc/physics/barrier.h"

namespace surf::mc {
namespace {

CascadeLibrary small_library(BarrierModel barrier) {
  const Material& material = io::find_material("Si", "test");
  Physics physics;
  physics.barrier = barrier;
  CascadeLibrary made({material, physics, 1000 + make_medium(material, physics).barrier_ev(), 5});
  made.grow(1, 0);
  return made;
}

/// Counts electrons that go up through the plane of the entry.
struct Crossings {
  double split_ev = 0, se = 0, bse = 0;
  void segment(const CascadeSegment& s) {
    if (!(s.from.z < 0 && s.to.z >= 0)) return;
    const double energy =
        s.energy_from_ev + (s.energy_to_ev - s.energy_from_ev) * s.from.z / (s.from.z - s.to.z);
    (energy >= split_ev ? bse : se) += 1;
  }
  void stop(const Vec3&, bool) {}
};

TEST(DiffusionMatrixTable, GivesTheLibrarysOwnValueOnFlatGround) {
  // Without a barrier what goes up through the plane can be counted.
  const CascadeLibrary library = small_library(BarrierModel::off);
  Crossings up;
  up.split_ev = library.medium().barrier_ev() + se_bse_split_ev;
  const EnergyCode code(library.medium().cutoff_ev(), library.settings().start_energy_ev);
  CascadeWalk<Crossings> walk(code, up);
  for (std::size_t i = 0; i < library.cascades(); ++i) walk.walk(library.cascade(i).data());
  const double n = static_cast<double>(library.cascades());
  const DiffusionMatrixParameters table = diffusion_matrix(library, {.rings = 64, .heights = 200});
  const auto model = make_diffusion_matrix({.pixel_nm = 3}, table);
  const ModelImages images = model->predict({{3, 3}, Grid<double>(4, 3)});
  EXPECT_NEAR(images[0](1, 1), up.se / n, 0.1 * up.se / n);
  EXPECT_NEAR(images[1](1, 1), up.bse / n, 0.1 * up.bse / n);
}

TEST(DiffusionMatrixTable, SecondOrderMomentsAddUpAndTheBarrierHoldsBack) {
  const CascadeLibrary library = small_library(BarrierModel::quantum);
  const DiffusionMatrixParameters table = diffusion_matrix(library);
  ASSERT_EQ(table.channels.size(), 2u);
  for (const DiffusionMatrixChannel& c : table.channels)
    for (std::size_t i = 0; i < c.moments_per_nm2.size(); i += diffusion_moments) {
      const double* m = c.moments_per_nm2.data() + i;
      for (int j = 2; j <= 4; ++j) ASSERT_GE(m[j], 0);
      ASSERT_LE(m[0] * m[0] + m[1] * m[1],
                (m[2] + m[3] + m[4]) * (m[2] + m[3] + m[4]) * (1 + 1e-9));
      ASSERT_LE(m[5] * m[5], m[2] * m[4] * (1 + 1e-9));
    }
  const auto flat = [&](const CascadeLibrary& l) {
    return make_diffusion_matrix({.pixel_nm = 3}, diffusion_matrix(l))
        ->predict({{3, 3}, Grid<double>(4, 3)});
  };
  const ModelImages held = flat(library);
  const auto yields = test::flat_yields("Si", 1000, 0, 20000);
  // It counts repeated crossings: above the yield, but of its size.
  EXPECT_GT(held[0](1, 1), 0.7 * yields.se.mean);
  EXPECT_LT(held[0](1, 1), 3 * yields.se.mean);
  EXPECT_GT(held[1](1, 1), 0.9 * yields.bse.mean);
  EXPECT_LT(held[1](1, 1), 2 * yields.bse.mean);
}

}  // namespace
}  // namespace surf::mc
