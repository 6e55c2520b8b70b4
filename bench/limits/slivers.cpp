// SPDX-License-Identifier: GPL-3.0-or-later
// A box with a row of triangles across it that are ever narrower: its image against that of the box
// without.
#include "simulations.h"
#include "surf/core/error.h"
#include "surf/mesh/repair_mesh.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

mc::SimulationResult image(const TriangleMesh& mesh, mc::Method method) {
  mc::Specimen s = bench::flat(bench::only_silicon());
  s.bodies.push_back({"box", mesh, 0});
  return simulate(mc::Scene(s, bench::beam(300), bench::view(60, 8)), method, 80);
}

std::vector<double> at(double aspect) {
  // Split in three; the second row of corners is moved next to the first.
  TriangleMesh mesh = make_box({-20, -20, 0}, {20, 20, 40}, 3);
  const double first_nm = -20 / 3.0;
  for (Vec3& v : mesh.vertices_nm)
    if (std::abs(v.x + first_nm) < 1) v.x = first_nm + 40 / 3.0 / aspect;
  static const TriangleMesh clean = make_box({-20, -20, 0}, {20, 20, 40});
  static const mc::SimulationResult expected[2] = {image(clean, mc::Method::direct),
                                                   image(clean, mc::Method::replay)};
  const MeshReport report = check_mesh(mesh);
  RepairSummary repair;
  repair = repair_mesh(mesh).summary;
  std::vector<double> row{0, static_cast<double>(report.degenerate_triangles),
                          static_cast<double>(repair.removed_degenerate)};
  try {
    double lost = 0;
    for (const mc::Method method : {mc::Method::direct, mc::Method::replay}) {
      const mc::SimulationResult r = image(mesh, method);
      lost += static_cast<double>(r.balance.total_lost());
      const Apart a = apart(expected[method == mc::Method::replay], r);
      row.insert(row.end(), {100 * a.rms, 100 * a.chance});
    }
    row.push_back(lost);
  } catch (const InvalidInput&) {
    row.assign(8, none);
    row[0] = 1;
  }
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Slivers across a box of 40 nm, silicon, 300 eV: nobody is lost";
  const io::PlotAxis x{"length of a sliver over its width", true, {}};
  out.panels = {
      panel(t, "image against that of the box without, rms of SE", x, {"difference (%)", false, {}},
            {{"direct_percent", "direct"},
             {"replay_percent", "replay", true},
             {"direct_chance_percent", "by chance alone", true}}),
      panel(t, "triangles said to have no area", x, {"triangles", false, {}},
            {{"degenerate", "check"}, {"removed", "removed by repair", true}})};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep slivers() {
  return {"slivers",
          "a box with triangles 1 to 1e16 times as long as wide",
          {"aspect", "refused", "degenerate", "removed", "direct_percent", "direct_chance_percent",
           "replay_percent", "replay_chance_percent", "lost_electrons"},
          {1, 1e2, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e12, 1e15, 1e16},
          at,
          1e7,
          1e-6,
          plot};
}

}  // namespace surf::limits
