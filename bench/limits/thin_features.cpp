// SPDX-License-Identifier: GPL-3.0-or-later
// A free film of silicon, and a fin on a substrate, from 100 nm down to less than an atom.
#include "simulations.h"
#include "surf/core/error.h"
#include "sweeps.h"

namespace surf::limits {
namespace {

std::vector<double> at(double thickness_nm) {
  std::vector<double> row{0};
  try {
    const mc::Scene film(body(make_box({-300, -300, -thickness_nm}, {300, 300, 0})),
                         bench::beam(300), bench::view(40, 8));
    double lost = 0;
    for (const mc::Method method : {mc::Method::direct, mc::Method::replay}) {
      const mc::SimulationResult r = simulate(film, method, 80);
      row.insert(row.end(), {static_cast<double>(r.balance.transmitted) /
                                 static_cast<double>(r.balance.incident),
                             mean_yield(r, se).mean, mean_yield(r, bse).mean});
      lost += static_cast<double>(r.balance.total_lost());
      if (method == mc::Method::replay) break;
      row.push_back(energy_unbalanced(r.balance));
    }
    mc::Specimen standing = bench::flat(bench::only_silicon());
    standing.bodies.push_back(
        {"fin", make_box({-thickness_nm / 2, -300, 0}, {thickness_nm / 2, 300, 30}), 0});
    const mc::Scene fin(standing, bench::beam(300), bench::view(8, 8));
    const mc::SimulationResult r = simulate(fin, mc::Method::direct, 40);
    row.insert(row.end(),
               {mean_yield(r, se).mean, lost + static_cast<double>(r.balance.total_lost())});
  } catch (const InvalidInput&) {
    row.assign(10, none);
    row[0] = 1;
  }
  return row;
}

io::Plot plot(const Table& t) {
  io::Plot out;
  out.title = "Thinner than a mean free path, silicon, 300 eV: below 0.01 nm refused";
  const io::PlotAxis x{"thickness (nm)", true, {}};
  out.panels = {panel(t, "a free film", x, {"electrons per primary", false, {}},
                      {{"transmitted", "transmitted, direct"},
                       {"transmitted_replay", "replay", true},
                       {"se", "SE, direct"},
                       {"se_replay", "replay", true},
                       {"bse", "BSE, direct"},
                       {"bse_replay", "replay", true}}),
                panel(t, "a fin of 30 nm on a substrate", x,
                      {"SE yield over 8 nm about it", false, {}}, {{"se_of_fin", ""}})};
  for (io::PlotPanel& p : out.panels)
    p.references = {{io::PlotDirection::vertical, 0.01, "thinnest accepted"}};
  out.columns = 2;
  return out;
}

}  // namespace

Sweep thin_features() {
  return {"thin_features",
          "a film and a fin of silicon from 100 nm to less than an atom",
          {"thickness_nm", "refused", "transmitted", "se", "bse", "energy_unbalanced",
           "transmitted_replay", "se_replay", "bse_replay", "se_of_fin", "lost_electrons"},
          {100, 30, 10, 5, 3, 1, 0.3, 0.1, 0.03, 0.01, 0.009, 0.003},
          at,
          0.1,
          1e-6,
          plot};
}

}  // namespace surf::limits
