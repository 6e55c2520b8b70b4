// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/material_plot.h"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "surf/mc/flat_yields.h"
#include "surf/mc/physics/dielectric_data.h"
#include "surf/mc/physics/full_penn.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/physics/single_pole.h"

namespace surf::workflow {
namespace {

constexpr double lowest_ev = 20, highest_ev = 3e4;  // above the vacuum level
constexpr int per_decade = 24;
constexpr double yield_energies_ev[] = {200, 300, 500, 800, 1000, 1500, 2000, 3000, 5000, 10000};
constexpr double least_elf = 1e-7;  // smaller values are not drawn

std::vector<double> energies_ev() {
  std::vector<double> out;
  const int count = static_cast<int>(std::lround(per_decade * std::log10(highest_ev / lowest_ev)));
  for (int i = 0; i <= count; ++i)
    out.push_back(lowest_ev * std::pow(highest_ev / lowest_ev, double(i) / count));
  return out;
}

io::PlotPanel panel(const char* title, const char* y) {
  io::PlotPanel p;
  p.title = title;
  p.x = {"energy above vacuum (eV)", true, {}};
  p.y = {y, true, {}};
  return p;
}

// Draws the positive values: the axes are logarithmic.
template <class F>
void draw(io::PlotPanel& panel, const char* name, const std::vector<double>& x, const F& f) {
  io::PlotSeries series;
  series.name = name;
  for (const double energy_ev : x) {
    const double y = f(energy_ev);
    if (!(y > 0) || !std::isfinite(y)) continue;
    series.x.push_back(energy_ev);
    series.y.push_back(y);
  }
  if (!series.y.empty()) panel.series.push_back(std::move(series));
}

io::PlotPanel loss_function(const mc::DielectricData& data) {
  io::PlotPanel p = panel("Energy-loss function", "Im(-1/\u03b5)");
  p.x.label = "energy loss (eV)";
  draw(p, "", data.elf.energies_ev(),
       [&](double w) { return data.elf(w) < least_elf ? 0 : data.elf(w); });
  for (const double shell : data.elf.shells_ev())
    if (shell > 20)
      p.references.push_back(
          {io::PlotDirection::vertical, shell, p.references.empty() ? "shells" : ""});
  if (data.band.gap_ev > data.elf.lowest_ev())
    p.bands.push_back(
        {io::PlotDirection::vertical, data.elf.lowest_ev(), data.band.gap_ev, "gap: lattice"});
  return p;
}

}  // namespace

namespace {

mc::Physics physics_of(const char* text) {
  mc::Physics physics;
  mc::parse_physics(text, physics);
  return physics;
}

// The yields of a plane normal to the beam, by both tiers.
io::PlotPanel yields(const mc::Material& material, const MaterialPlotOptions& options) {
  io::PlotPanel p;
  p.title = "Yields of a plane";
  p.x = {"energy of the beam (eV)", true, {}};
  p.y = {"electrons per primary", false, {}};
  struct Tier {
    const char *words, *name;
  };
  constexpr Tier tiers[] = {{"inelastic=dielectric", "dielectric"}, {"inelastic=monsel", "monsel"}};
  const std::size_t energies = std::size(yield_energies_ev);
  double done = 0;
  for (const Tier& tier : tiers) {
    io::PlotSeries se, bse;
    se.name = std::string("SE, ") + tier.name;
    bse.name = std::string("BSE, ") + tier.name;
    for (const double energy_ev : yield_energies_ev) {
      const double part = 1.0 / (double(energies) * double(std::size(tiers)));
      const mc::FlatYields y =
          mc::flat_yields(material, energy_ev, options.electrons, physics_of(tier.words),
                          options.threads, options.watch.part(done, done + part));
      done += part;
      se.x.push_back(energy_ev), se.y.push_back(y.se.mean);
      bse.x.push_back(energy_ev), bse.y.push_back(y.bse.mean);
    }
    p.series.push_back(std::move(se));
    p.series.push_back(std::move(bse));
  }
  return p;
}

}  // namespace

io::Plot plot_material(const mc::Material& material, const MaterialPlotOptions& options) {
  const mc::DielectricData& data = *material.dielectric;
  const mc::Medium monsel = mc::make_medium(material, physics_of("secondaries=off"));
  const mc::Medium slow =
      mc::make_medium(material, physics_of("secondaries=off,elastic=mott-phonon,atoms=solid"));
  const mc::FullPenn full(data);
  const mc::SinglePole pole(data.elf, data.band);
  const std::vector<double> x = energies_ev();
  // The same electron inside the material. The tiers count energies from the bottom of the
  // conduction band and from that of the filled band.
  const auto inside = [&](double energy_ev) { return energy_ev + material.barrier_ev; };
  const auto in_band = [&](double energy_ev) { return energy_ev + data.barrier_ev(); };

  io::Plot plot;
  plot.title = material.name;
  plot.panels.push_back(loss_function(data));
  io::PlotPanel paths = panel("Free paths", "free path (nm)");
  draw(paths, "losses: full Penn", x,
       [&](double e) { return 1 / full.inverse_mean_free_path_per_nm(in_band(e)); });
  draw(paths, "losses: single pole", x,
       [&](double e) { return 1 / pole.inverse_mean_free_path_per_nm(in_band(e)); });
  draw(paths, "elastic: phonons, atoms of a solid", x,
       [&](double e) { return 1 / slow.inverse_mean_free_path_per_nm(inside(e)); });
  draw(paths, "elastic, monsel: free atoms", x,
       [&](double e) { return 1 / monsel.inverse_mean_free_path_per_nm(inside(e)); });
  plot.panels.push_back(std::move(paths));
  io::PlotPanel stopping = panel("Loss per length", "loss (eV/nm)");
  draw(stopping, "full Penn", x,
       [&](double e) { return full.stopping_power_ev_per_nm(in_band(e)); });
  draw(stopping, "single pole", x,
       [&](double e) { return pole.stopping_power_ev_per_nm(in_band(e)); });
  draw(stopping, "monsel: Joy and Luo", x,
       [&](double e) { return monsel.stopping_power_ev_per_nm(inside(e)); });
  plot.panels.push_back(std::move(stopping));
  plot.panels.push_back(yields(material, options));
  plot.columns = 2;
  return plot;
}

}  // namespace surf::workflow
