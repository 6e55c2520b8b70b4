// SPDX-License-Identifier: GPL-3.0-or-later
// Two plates of silicon on each other with a gap between: when they are one, and what a gap does
// that is not there in nature. The beam meets the upper plate, 3 nm thick.
#include "simulations.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

mc::Scan scan() { return bench::view(20, 8); }

std::vector<double> at(double gap_nm) {
  static const mc::SimulationResult one = simulate(
      mc::Scene(body(make_box({-300, -300, -60}, {300, 300, 0})), bench::beam(500), scan()),
      mc::Method::direct, 300);
  mc::Specimen s = body(make_box({-300, -300, -60 - gap_nm}, {300, 300, -3 - gap_nm}));
  s.bodies.push_back({"upper", make_box({-300, -300, -3}, {300, 300, 0}), 0});
  const mc::Scene scene(s, bench::beam(500), scan());
  const mc::SimulationResult direct = simulate(scene, mc::Method::direct, 300);
  const mc::SimulationResult replay = simulate(scene, mc::Method::replay, 300);
  const mc::Estimate e = mean_yield(direct, se), of_one = mean_yield(one, se),
                     r = mean_yield(replay, se);
  const double scale = 100 / of_one.mean;
  return {scale * (e.mean - of_one.mean),
          scale * std::hypot(e.standard_error, of_one.standard_error),
          scale * (r.mean - of_one.mean),
          scale * std::hypot(r.standard_error, of_one.standard_error),
          static_cast<double>(direct.balance.total_lost() + replay.balance.total_lost()),
          energy_unbalanced(direct.balance)};
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Two plates with a gap, silicon, 500 eV: one interface below 0.001 nm";
  io::PlotPanel p = panel(t, "", {"gap (nm)", true, {}}, {"SE against one plate's (%)", false, {}},
                          {{"direct_percent", "direct"}, {"replay_percent", "replay", true}});
  p.references = {{io::PlotDirection::vertical, 1e-3, "faces nearer than this are one"},
                  {io::PlotDirection::horizontal, 0, ""}};
  out.panels = {std::move(p)};
  return out;
}

}  // namespace

Sweep coincident_faces() {
  return {"coincident_faces",
          "two plates with a gap of 10 nm to nothing between them",
          {"gap_nm", "direct_percent", "direct_percent_error", "replay_percent",
           "replay_percent_error", "lost_electrons", "energy_unbalanced"},
          {10, 1, 0.1, 0.03, 0.01, 3e-3, 1.2e-3, 8e-4, 3e-4, 1e-4, 1e-5, 1e-6, 0},
          at,
          1.2e-3,
          1e-6,
          plot};
}

}  // namespace surf::limits
