// SPDX-License-Identifier: GPL-3.0-or-later
// A ball of which more and more triangles face inward: what is refused, and what repair makes of
// it.
#include "simulations.h"
#include "surf/core/error.h"
#include "surf/core/random.h"
#include "surf/mesh/repair_mesh.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double percent) {
  TriangleMesh mesh = make_sphere({0, 0, 0}, 30, 3);
  const double volume = check_mesh(mesh).signed_volume_nm3;
  RandomStream random(1, 0, 0);
  for (Triangle& t : mesh.triangles)
    if (100 * random.uniform() < percent) std::swap(t[1], t[2]);
  double refused = 0, lost = none;
  try {
    const mc::SimulationResult r = simulate(
        mc::Scene(body(mesh), bench::beam(300), bench::view(48, 8)), mc::Method::direct, 20);
    lost = static_cast<double>(r.balance.total_lost());
  } catch (const InvalidInput&) {
    refused = 1;
  }
  RepairSummary repair;
  repair = repair_mesh(mesh).summary;
  const auto share = [&](std::size_t n) {
    return 100 * static_cast<double>(n) / static_cast<double>(mesh.triangles.size());
  };
  return {refused,
          lost,
          100 * static_cast<double>(repair.before.inconsistent_edges) /
              (1.5 * static_cast<double>(mesh.triangles.size())),
          share(repair.turned_triangles),
          repair.sound() ? 1.0 : 0.0,
          100 * repair.after.signed_volume_nm3 / volume};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Flipped triangles of a ball: refused unless all or none, always mended";
  const io::PlotAxis x{"triangles that face inward (%)", false, {}};
  out.panels = {panel(t, "", x, {"%", false, {}},
                      {{"edges_percent", "edges found inconsistent"},
                       {"turned_percent", "triangles that repair turns", true},
                       {"volume_percent", "volume afterwards, of the ball's"}}),
                panel(t, "simulate", x, {"1: refused", false, io::PlotAxis::Range{-0.1, 1.2}},
                      {{"refused", ""}})};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep flipped_normals() {
  return {"flipped_normals",
          "a ball with 0 to 100 % of its triangles facing inward",
          {"flipped_percent", "refused", "lost_electrons", "edges_percent", "turned_percent",
           "sound", "volume_percent"},
          {0, 0.1, 1, 5, 20, 40, 50, 60, 80, 95, 99.9, 100},
          at,
          60,
          1e-6,
          plot};
}

}  // namespace surf::limits
