// SPDX-License-Identifier: GPL-3.0-or-later
// A rough height field of ever fewer triangles (--mesh-tolerance): the image's error beside its
// noise.
#include "simulations.h"
#include "surf/core/error.h"
#include "surf/workflow/simplify_specimen.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

mc::Specimen rough() {
  mc::Specimen s = bench::only_silicon();
  s.height_field =
      mc::HeightFieldBody{"rough", make_rough({120, 120, 1}, 3, 12, 1), 0, Edge::periodic};
  return s;
}

mc::SimulationResult image(const mc::Specimen& s, std::uint64_t seed) {
  return simulate(mc::Scene(s, bench::beam(300), bench::view(90, 8)), mc::Method::replay, 150,
                  seed);
}

std::vector<double> at(double tolerance_nm) {
  static const mc::SimulationResult all = image(rough(), 1);
  workflow::Simplification done;
  const mc::Specimen simple = workflow::simplify_specimen(rough(), tolerance_nm, bench::beam(300),
                                                          bench::view(90, 8), {}, 0, done);
  const double warned = workflow::warnings_of(rough(), done).empty() ? 0 : 1;
  const mc::SimulationResult r = image(simple, 1);
  const Apart a = apart(all, r);
  const double mean = 100 * (mean_yield(r, se).mean / mean_yield(all, se).mean - 1);
  return {static_cast<double>(done.bodies.at(0).triangles_after) /
              static_cast<double>(done.bodies.at(0).triangles_before),
          warned, 100 * a.rms, 100 * a.chance, mean};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Leaving out detail of a rough surface (rms 3 nm), silicon, 300 eV";
  const io::PlotAxis x{"tolerance (nm)", true, {}};
  out.panels = {panel(t, "", x, {"difference of SE images, rms (%)", false, {}},
                      {{"rms_percent", "found"},
                       {"chance_percent", "by chance alone", true},
                       {"mean_percent", "of the means"}}),
                panel(t, "", x, {"triangles left, share", true, {}}, {{"triangles_share", ""}})};
  for (io::PlotPanel& p : out.panels)
    p.references = {{io::PlotDirection::vertical, 3, "the surface's rms"}};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep mesh_tolerance() {
  return {"mesh_tolerance",
          "a rough surface simplified within 0.02 to 30 nm",
          {"tolerance_nm", "triangles_share", "warned", "rms_percent", "chance_percent",
           "mean_percent"},
          {0.02, 0.1, 0.3, 1, 2, 3, 5, 8, 12, 30},
          at,
          3,
          1e-6,
          plot};
}

}  // namespace surf::limits
