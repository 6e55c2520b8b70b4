// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/transport/energy_deposit.h"

#include "specimens.h"
#include "statistics.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mesh/shapes.h"

namespace surf::mc {

namespace {

DepositGrid unit_grid() { return {{{0, 0, 0}, {4, 2, 2}}, {4, 2, 2}}; }

double sum(const EnergyDeposit& d, const DepositGrid& g) {
  double total = d.outside().ev();
  for (int k = 0; k < g.cells[2]; ++k)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int i = 0; i < g.cells[0]; ++i) total += d.cell(i, j, k).ev();
  return total;
}

}  // namespace

TEST(EnergyDeposit, SharesAPieceByLength) {
  EnergyDeposit d(unit_grid());
  d.deposit({0.5, 0.5, 0.5}, {3, 0.5, 0.5}, 10);  // 0.5, 1, 1 of 2.5; it ends on a wall
  EXPECT_NEAR(d.cell(0, 0, 0).ev(), 2, 1e-4);
  EXPECT_NEAR(d.cell(1, 0, 0).ev(), 4, 1e-4);
  EXPECT_NEAR(d.cell(2, 0, 0).ev(), 4, 1e-4);
  d.deposit({3.5, 1.5, 1.5}, {3.5, 1.5, 1.5}, 1);
  EXPECT_EQ(d.cell(3, 1, 1).ev(), 1);
  d.deposit({-3, 0.5, 1.5}, {1, 0.5, 1.5}, 8);  // three quarters outside
  EXPECT_NEAR(d.cell(0, 0, 1).ev(), 2, 1e-4);
  EXPECT_NEAR(d.outside().ev(), 6, 1e-4);
}

TEST(EnergyDeposit, LosesNothing) {
  RandomStream random(1, 0, 0);
  const DepositGrid grid = unit_grid();
  EnergyDeposit d(grid);
  const auto point = [&] {
    return Vec3{6 * random.uniform() - 1, 4 * random.uniform() - 1, 4 * random.uniform() - 1};
  };
  double given = 0;
  for (int i = 0; i < 20000; ++i) {
    const double energy = 10 * (random.uniform() - 0.3);
    d.deposit(point(), point(), energy);
    given += energy;
  }
  EXPECT_NEAR(sum(d, grid), given, 20000 * 8 * 0x1p-17);
}

TEST(EnergyDeposit, HoldsWhatDidNotEscape) {
  Specimen specimen = test::flat("Si");
  specimen.materials.push_back(io::find_material("Au", "test"));
  specimen.bodies.push_back({"film", make_box({-40, -40, 0}, {40, 40, 3}), 1});
  const Scene scene(specimen, {}, test::square_scan(20, 2));
  const DepositGrid grid = deposit_grid(scene, 32);
  std::vector<EnergyDeposit> per_thread(3, EnergyDeposit(grid));
  SimulationOptions options;
  options.budget = ElectronsPerPixel{300};
  options.threads = 3;
  options.tile_pixels = 1;
  const auto r = simulate(scene, options, {.observers = [&](int thread) {
                            return &per_thread[static_cast<std::size_t>(thread)];
                          }});
  EnergyDeposit all(grid);
  for (const EnergyDeposit& d : per_thread) all += d;
  const Balance& b = r.balance;
  EXPECT_EQ(b.total_lost(), 0);
  EXPECT_NEAR(sum(all, grid), b.incident_energy.ev() - b.escaped_energy.ev(), 20);
  // All but a trace of it lies inside the default grid, and gold takes more than as much silicon.
  EXPECT_LT(all.outside().ev(), 0.01 * b.incident_energy.ev());
  const Volume v = all.density(b.incident);
  double volume_sum = 0;
  for (const double x : v.values) volume_sum += x;
  EXPECT_NEAR(volume_sum * v.cell_nm.x * v.cell_nm.y * v.cell_nm.z * double(b.incident),
              sum(all, grid) - all.outside().ev(), 1);
}

TEST(EnergyDeposit, RefusesAnEmptyGrid) {
  EXPECT_THROW(EnergyDeposit({{{0, 0, 0}, {1, 1, 0}}, {1, 1, 1}}), UsageError);
  EXPECT_THROW(EnergyDeposit({{{0, 0, 0}, {1, 1, 1}}, {1, 0, 1}}), UsageError);
  EXPECT_THROW(EnergyDeposit({{{0, 0, 0}, {1, 1, 1}}, {4096, 4096, 4096}}), UsageError);
}

}  // namespace surf::mc
