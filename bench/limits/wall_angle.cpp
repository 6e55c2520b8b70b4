// SPDX-License-Identifier: GPL-3.0-or-later
// A ridge on a substrate whose left wall is ever steeper, and leans over in the end, under a beam
// from straight above: images made by both methods against each other.
#include "simulations.h"
#include "surf/core/units.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double height_nm = 60;

std::vector<double> at(double wall_deg) {
  mc::Specimen s = bench::flat(bench::only_silicon());
  TriangleMesh ridge = make_box({0, -300, 0}, {60, 300, height_nm});
  for (Vec3& v : ridge.vertices_nm)
    if (v.x == 0 && v.z == 0)
      v.x = -height_nm * std::cos(wall_deg * degrees_to_radians) /
            std::sin(wall_deg * degrees_to_radians);
  s.bodies.push_back({"ridge", ridge, 0});
  mc::Scan scan = bench::view(40, 20);
  scan.height = 12;
  const mc::Scene scene(s, bench::beam(300), scan);
  const mc::SimulationResult direct = simulate(scene, mc::Method::direct, 100);
  const mc::SimulationResult replay = simulate(scene, mc::Method::replay, 100);
  const Apart a = apart(direct, replay);
  double brightest = 0;
  for (int x = 0; x < scan.width; ++x) {
    double column = 0;
    for (int y = 0; y < scan.height; ++y) column += direct.yield(se, x, y).mean / scan.height;
    brightest = std::max(brightest, column);
  }
  return {brightest, 100 * a.rms, 100 * a.chance,
          static_cast<double>(direct.balance.total_lost() + replay.balance.total_lost()),
          energy_unbalanced(direct.balance)};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "A wall of 80 to 100 degrees, silicon, 300 eV: nobody is lost";
  const io::PlotAxis x{"angle of the wall (degrees; above 90 it leans over)", false, {}};
  out.panels = {
      panel(t, "", x, {"SE yield of the brightest column", false, {}}, {{"brightest_se", ""}}),
      panel(t, "", x, {"direct against replay, rms of SE (%)", false, io::PlotAxis::Range{0, 20}},
            {{"rms_percent", "found"}, {"chance_percent", "by chance alone", true}})};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep wall_angle() {
  return {"wall_angle",
          "direct against replay at a wall of 80 to 100 degrees",
          {"wall_deg", "brightest_se", "rms_percent", "chance_percent", "lost_electrons",
           "energy_unbalanced"},
          {80, 84, 87, 89, 89.5, 89.9, 90, 90.1, 91, 95, 100},
          at,
          90,
          1e-6,
          plot};
}

}  // namespace surf::limits
