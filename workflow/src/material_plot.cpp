// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/material_plot.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "surf/mc/physics/dielectric_data.h"
#include "surf/mc/physics/medium.h"

namespace surf::workflow {
namespace {

constexpr double lowest_ev = 20, highest_ev = 3e4;   // above the vacuum level
constexpr int per_decade = 24;
constexpr double least_elf = 1e-7;                   // what is smaller is not drawn

std::vector<double> energies_ev() {
  std::vector<double> out;
  const int count = static_cast<int>(std::lround(per_decade * std::log10(highest_ev / lowest_ev)));
  for (int i = 0; i <= count; ++i) out.push_back(lowest_ev * std::pow(highest_ev / lowest_ev, double(i) / count));
  return out;
}

io::PlotPanel panel(const char* title, const char* y) {
  io::PlotPanel p;
  p.title = title;
  p.x = {"energy above vacuum (eV)", true, {}};
  p.y = {y, true, {}};
  return p;
}

// Of what is positive: the axes are logarithmic.
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
  draw(p, "", data.elf.energies_ev(), [&](double w) { return data.elf(w) < least_elf ? 0 : data.elf(w); });
  for (const double shell : data.elf.shells_ev())
    if (shell > 20) p.references.push_back({io::PlotDirection::vertical, shell, p.references.empty() ? "shells" : ""});
  if (data.band.gap_ev > data.elf.lowest_ev())
    p.bands.push_back({io::PlotDirection::vertical, data.elf.lowest_ev(), data.band.gap_ev, "gap: lattice"});
  return p;
}

}  // namespace

io::Plot plot_material(const mc::Material& material) {
  mc::Physics elastic_only;
  elastic_only.secondaries = false;
  const mc::Medium elastic = mc::make_medium(material, elastic_only), used = mc::make_medium(material, {});
  const auto data = mc::find_dielectric_data(material);
  std::optional<mc::SinglePole> losses;
  if (data) losses.emplace(data->elf, data->band);
  const std::vector<double> x = energies_ev();
  // The same electron inside: simulations count from the bottom of the conduction band, losses from that of the valence band.
  const auto inside = [&](double energy_ev) { return energy_ev + material.barrier_ev; };
  const auto in_band = [&](double energy_ev) { return energy_ev + data->band.filled_ev + material.work_function_ev; };

  io::Plot plot;
  plot.title = material.name;
  if (data) plot.panels.push_back(loss_function(*data));
  io::PlotPanel paths = panel("Free paths", "free path (nm)");
  if (losses)
    draw(paths, "inelastic, energy-loss function", x,
         [&](double e) { return 1 / losses->inverse_mean_free_path_per_nm(in_band(e)); });
  draw(paths, "elastic, in use: Mott, isotropic below 50 eV", x, [&](double e) { return 1 / elastic.inverse_mean_free_path_per_nm(inside(e)); });
  plot.panels.push_back(std::move(paths));
  io::PlotPanel stopping = panel("Loss per length", "loss (eV/nm)");
  if (losses)
    draw(stopping, "energy-loss function", x, [&](double e) { return losses->stopping_power_ev_per_nm(in_band(e)); });
  draw(stopping, "in use: Joy and Luo", x, [&](double e) { return used.stopping_power_ev_per_nm(inside(e)); });
  plot.panels.push_back(std::move(stopping));
  plot.columns = static_cast<int>(plot.panels.size());
  return plot;
}

}  // namespace surf::workflow
