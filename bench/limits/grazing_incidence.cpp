// SPDX-License-Identifier: GPL-3.0-or-later
// Flat silicon under a beam that comes in ever flatter: what is followed and what is replayed, and
// who is lost.
#include "simulations.h"
#include "surf/core/error.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double above_surface_deg) {
  mc::Beam beam = bench::beam(300);
  beam.tilt_deg = 90 - above_surface_deg;
  std::vector<double> row{0};
  try {
    const mc::Scene scene(bench::flat(bench::only_silicon()), beam, bench::view(100, 8));
    double lost = 0, unbalanced = 0;
    for (const mc::Method method : {mc::Method::direct, mc::Method::replay}) {
      const mc::SimulationResult r = simulate(scene, method, 100);
      for (const std::size_t d : {se, bse}) {
        const mc::Estimate e = mean_yield(r, d);
        row.insert(row.end(), {e.mean, e.standard_error});
      }
      lost += static_cast<double>(r.balance.total_lost());
      if (method == mc::Method::direct) unbalanced = energy_unbalanced(r.balance);
    }
    row.insert(row.end(), {lost, unbalanced});
  } catch (const UsageError&) {
    row.assign(11, none);
    row[0] = 1;
  }
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "A beam that grazes flat silicon, 300 eV";
  io::PlotPanel p = panel(t, "", {"angle between beam and surface (degrees)", true, {}},
                          {"electrons per primary", false, {}},
                          {{"se", "SE, direct"},
                           {"se_replay", "SE, replay", true},
                           {"bse", "BSE, direct"},
                           {"bse_replay", "BSE, replay", true}});
  p.references = {{io::PlotDirection::vertical, 0.0573, "refused below"}};
  out.panels = {std::move(p)};
  return out;
}

}  // namespace

Sweep grazing_incidence() {
  return {
      "grazing_incidence",
      "yields of flat silicon for a beam 90 to 0 degrees above its surface",
      {"above_surface_deg", "refused", "se", "se_error", "bse", "bse_error", "se_replay",
       "se_replay_error", "bse_replay", "bse_replay_error", "lost_electrons", "energy_unbalanced"},
      {90, 60, 30, 15, 10, 5, 2, 1, 0.5, 0.1, 0.01, 0.001, 0},
      at,
      0.1,
      1e-6,
      plot};
}

}  // namespace surf::limits
