// SPDX-License-Identifier: GPL-3.0-or-later
// An L of two boxes on a substrate, moved away from the origin with the scan: its image against the
// one there.
#include "simulations.h"
#include "surf/core/error.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

mc::SimulationResult image(double offset_nm, mc::Method method) {
  const Vec3 by{offset_nm, -offset_nm, offset_nm};
  mc::Specimen s = bench::flat(bench::only_silicon());
  s.substrate->top_nm = by.z;
  s.bodies.push_back({"long", make_box(by + Vec3{-30, -10, 0}, by + Vec3{30, 10, 40}), 0});
  s.bodies.push_back({"short", make_box(by + Vec3{10, 10, 0}, by + Vec3{30, 30, 20}), 0});
  mc::Scan scan = bench::view(84, 10);
  scan.center_x_nm = by.x;
  scan.center_y_nm = by.y;
  scan.center_z_nm = by.z;
  return simulate(mc::Scene(s, bench::beam(300), scan), method, 60);
}

std::vector<double> at(double offset_nm) {
  std::vector<double> row{0};
  double lost = 0;
  static const mc::SimulationResult expected[2] = {image(0, mc::Method::direct),
                                                   image(0, mc::Method::replay)};
  try {
    for (const mc::Method method : {mc::Method::direct, mc::Method::replay}) {
      const mc::SimulationResult far = image(offset_nm, method);
      const Apart a = apart(expected[method == mc::Method::replay], far);
      row.insert(row.end(), {100 * a.rms, 100 * a.chance});
      lost = std::max(lost, 100 * share_lost(far.balance));
    }
    row.push_back(lost);
  } catch (const InvalidInput&) {
    row.assign(6, none);
    row[0] = 1;
  }
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "An L of silicon far from the origin, 300 eV";
  const io::PlotAxis x{"offset of x, y and z (nm)", true, {}};
  out.panels = {
      panel(t, "image against the one at the origin, rms of SE", x, {"difference (%)", true, {}},
            {{"direct_percent", "direct"},
             {"replay_percent", "replay", true},
             {"direct_chance_percent", "by chance alone", true}}),
      panel(t, "electrons given up", x, {"share (%)", false, {}}, {{"lost_percent", ""}})};
  for (io::PlotPanel& p : out.panels) p.references = {{io::PlotDirection::vertical, 1e9, "1 m"}};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep far_origin() {
  return {"far_origin",
          "an L of boxes 1 um to 100 km from the origin",
          {"offset_nm", "refused", "direct_percent", "direct_chance_percent", "replay_percent",
           "replay_chance_percent", "lost_percent"},
          {1e3, 1e6, 1e8, 1e9, 3e9, 1e10, 1e11, 1e12, 1e13, 1e14},
          at,
          1e11,
          1e-6,
          plot};
}

}  // namespace surf::limits
