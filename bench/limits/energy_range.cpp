// SPDX-License-Identifier: GPL-3.0-or-later
// Flat silicon from 100 eV to 30 keV: yields beside direct simulation's, and whether all electrons
// and all energy are accounted for.
#include <cmath>
#include <cstdlib>

#include "../scenes.h"
#include "surf/mc/results/result_summary.h"
#include "surf/mc/simulate.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

constexpr int pixels = 8;
constexpr std::int64_t primaries = 20000;  // in all, at 1 keV; less where each takes longer

std::vector<double> at(double energy_ev) {
  const mc::Scene scene(bench::flat(bench::only_silicon()), bench::beam(energy_ev),
                        bench::view(100, pixels));
  const double share = std::min(1.0, 1000 / energy_ev);
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{
      static_cast<std::int64_t>(std::ceil(share * primaries / (pixels * pixels)))};
  std::vector<double> row;
  double mean[2][2], error[2][2];
  for (const mc::Method method : {mc::Method::direct, mc::Method::replay}) {
    options.method = method;
    const mc::SimulationResult r = mc::simulate(scene, options);
    // With the library's own share, which is common to all pixels.
    const mc::ResultSummary summary = mc::summarize(r);
    const int m = method == mc::Method::direct ? 0 : 1;
    for (std::size_t d = 0; d < 2; ++d) {
      mean[m][d] = summary.yields[d].mean;
      error[m][d] = summary.yields[d].standard_error;
    }
    if (method == mc::Method::direct) {
      const mc::Balance& b = r.balance;
      const double in = b.incident_energy.ev() + b.generated_energy.ev();
      const double out = b.escaped_energy.ev() + b.deposited_energy.ev() + b.lost_energy.ev();
      row = {mean[0][0],
             error[0][0],
             mean[0][1],
             error[0][1],
             static_cast<double>(b.total_lost()),
             std::abs(in - out) / in};
    }
  }
  row.insert(row.end(), {mean[1][0], error[1][0], mean[1][1], error[1][1]});
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Flat silicon: electrons per primary, followed and replayed";
  out.panels = {panel(t, "", {"energy (eV)", true, {}}, {"yield", true, {}},
                      {{"se", "SE, direct"},
                       {"se_replay", "SE, replay", true},
                       {"bse", "BSE, direct"},
                       {"bse_replay", "BSE, replay", true}})};
  return out;
}

}  // namespace

Sweep energy_range() {
  return {"energy_range",
          "yields of silicon, and what is lost, from 100 eV to 30 keV",
          {"energy_ev", "se", "se_error", "bse", "bse_error", "lost_electrons", "energy_unbalanced",
           "se_replay", "se_replay_error", "bse_replay", "bse_replay_error"},
          {100, 200, 300, 500, 1000, 2000, 3000, 5000, 10000, 20000, 30000},
          at,
          200,
          1e-6,
          plot};
}

}  // namespace surf::limits
