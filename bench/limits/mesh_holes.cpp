// SPDX-License-Identifier: GPL-3.0-or-later
// A ball with a round hole at the top, seen from above: what the simulator takes it for, and the
// image after `repair_mesh` against that of the whole ball.
#include "simulations.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mesh/mesh_deviation.h"
#include "surf/mesh/repair_mesh.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr double radius_nm = 30;

mc::SimulationResult image(const TriangleMesh& mesh) {
  return simulate(mc::Scene(body(mesh), bench::beam(300), bench::view(48, 8)), mc::Method::direct,
                  60);
}

std::vector<double> at(double hole_deg) {
  const TriangleMesh whole = make_sphere({0, 0, 0}, radius_nm, 4);
  TriangleMesh open = whole;
  // By the middles of triangles: a hole narrower than one takes the one at the top.
  const double rim_nm = radius_nm * std::cos(hole_deg * degrees_to_radians);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return (open.vertices_nm[t[0]].z + open.vertices_nm[t[1]].z + open.vertices_nm[t[2]].z) / 3 >
           rim_nm;
  });
  open = merge_equal_vertices(open);  // without those that no triangle uses any more
  static const mc::SimulationResult of_whole = image(whole);
  double refused = 0, sheet = 0, off = none;
  try {
    mc::validate(body(open));
    sheet = mc::is_sheet(body(open).bodies[0]);
    if (sheet > 0) off = 100 * apart(of_whole, image(open)).rms;
  } catch (const InvalidInput&) {
    refused = 1;
  }
  const auto [closed, repair] = repair_mesh(open);
  double mended = repair.sound() ? 1 : 0, off_mended = none, chance = none;
  if (repair.sound()) {
    const Apart a = apart(of_whole, image(closed));
    off_mended = 100 * a.rms;
    chance = 100 * a.chance;
  }
  return {refused, sheet, mended, off, off_mended, chance, repair.after.signed_volume_nm3};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "A ball of 30 nm with a hole at the top, silicon, 300 eV";
  out.panels = {
      panel(t, "image against the whole ball's, rms of SE",
            {"half angle of the hole (degrees)", false, {}}, {"difference (%)", false, {}},
            {{"off_repaired_percent", "after --repair"},
             {"off_as_given_percent", "as it is, a half-space's top"},
             {"chance_percent", "by chance alone", true}}),
      panel(t, "what is said", {"half angle of the hole (degrees)", false, {}},
            {"1: yes", false, io::PlotAxis::Range{-0.1, 1.3}},
            {{"refused", "refused as open"},
             {"taken_as_half_space", "taken for a half-space's top", true},
             {"repaired", "repair closes it", true}})};
  out.columns = 1;
  return out;
}

}  // namespace

Sweep mesh_holes() {
  return {"mesh_holes",
          "a ball with a hole of 0 to 150 degrees half angle: simulated, refused, repaired",
          {"hole_deg", "refused", "taken_as_half_space", "repaired", "off_as_given_percent",
           "off_repaired_percent", "chance_percent", "repaired_volume_nm3"},
          {0, 5, 10, 15, 18, 25, 40, 60, 80, 95, 120, 150},
          at,
          15,
          1e-6,
          plot};
}

}  // namespace surf::limits
