// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/library_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "surf/core/error.h"
#include "surf/core/some_parameters.h"
#include "surf/mc/physics/element.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {

namespace {

constexpr std::size_t most_materials = 8;      // number of colours
constexpr std::size_t most_distributions = 8;  // distributions in one panel
constexpr std::size_t bins = 40;
constexpr double percentile = 0.95;

std::string energy_text(double energy_ev) {
  return energy_ev >= 1000 ? fmt::format("{:g} keV", energy_ev / 1000)
                           : fmt::format("{:g} eV", energy_ev);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double percentile_of(std::vector<double> values) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(percentile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The results for one material at one energy.
struct Findings {
  std::size_t material = 0;
  double energy_ev = 0;
  std::vector<double> depth_nm, extent_nm;  // of every primary
  std::vector<mc::Estimate> se, bse;        // by tilt
};

class Charts {
 public:
  Charts(const LibraryPlotOptions& options, std::size_t cascades, std::vector<double> tilts_deg)
      : options_(options), cascades_(cascades), tilts_deg_(std::move(tilts_deg)) {}

  std::vector<Findings> findings;

  io::Plot plot() const {
    io::Plot plot;
    plot.title = fmt::format("{} cascades of each", cascades_);
    if (!several()) plot.title = energy_text(options_.energies_ev.front()) + ", " + plot.title;
    const std::string physics = mc::format_physics(options_.physics);
    if (physics != mc::format_physics({})) plot.title += "\n" + physics;
    plot.panels.push_back(
        distribution("How deep primaries get", "greatest depth (nm)", &Findings::depth_nm));
    plot.panels.push_back(distribution(
        "How far primaries get", "greatest distance from the start (nm)", &Findings::extent_nm));
    if (several()) plot.panels.push_back(ranges());
    plot.panels.push_back(yields("Secondary electrons", "SE per primary", &Findings::se, false));
    plot.panels.push_back(
        yields("Backscattered electrons", "BSE per primary", &Findings::bse, true));
    plot.columns = several() ? 3 : 2;
    return plot;
  }

 private:
  bool several() const { return options_.energies_ev.size() > 1; }

  // A logarithmic axis needs more than a decade to show several numbers.
  io::PlotAxis energy_axis() const {
    const auto [low, high] =
        std::minmax_element(options_.energies_ev.begin(), options_.energies_ev.end());
    io::PlotAxis axis;
    axis.label = "energy (keV)";
    axis.log = *high > 20 * *low;
    return axis;
  }

  std::string name(const Findings& f) const {
    const std::string& material = options_.materials[f.material].name;
    return several() ? fmt::format("{}, {}", material, energy_text(f.energy_ev)) : material;
  }

  // A subset that is small enough to distinguish: the same energies for each material, from first
  // to last.
  std::vector<const Findings*> chosen() const {
    const std::size_t energies = options_.energies_ev.size();
    const std::size_t each =
        std::clamp(most_distributions / options_.materials.size(), std::size_t{1}, energies);
    std::vector<const Findings*> out;
    for (std::size_t m = 0; m < options_.materials.size(); ++m)
      for (std::size_t i = 0; i < each; ++i)
        out.push_back(
            &findings[m * energies + (each > 1 ? i * (energies - 1) / (each - 1) : energies / 2)]);
    return out;
  }

  io::PlotPanel distribution(const char* title, const char* label,
                             std::vector<double> Findings::*values) const {
    io::PlotPanel panel;
    panel.title = title;
    panel.x.label = label;
    panel.y.label = fmt::format("% of primaries in a bin");
    double low = 1e300, high = 0;
    for (const Findings* f : chosen()) {
      const auto [least, most] = std::minmax_element((f->*values).begin(), (f->*values).end());
      low = std::min(low, *least);
      high = std::max(high, *most);
    }
    // Energies far apart have such different ranges that they need a logarithmic axis.
    double least_mean = 1e300, greatest_mean = 0;
    for (const Findings* f : chosen()) {
      least_mean = std::min(least_mean, mean(f->*values));
      greatest_mean = std::max(greatest_mean, mean(f->*values));
    }
    panel.x.log = greatest_mean > 4 * least_mean;
    low = panel.x.log ? std::max(low, least_mean / 30) : 0;
    std::vector<double> edges(bins + 1);
    for (std::size_t i = 0; i <= bins; ++i) {
      const double share = static_cast<double>(i) / bins;
      edges[i] = panel.x.log ? low * std::pow(high / low, share) : low + (high - low) * share;
    }
    for (const Findings* f : chosen()) {
      io::PlotSeries series;
      series.name = name(*f);
      series.style = io::PlotStyle::steps;
      series.x = edges;
      series.y.assign(bins, 0);
      for (const double v : f->*values) {
        const auto above = std::upper_bound(edges.begin(), edges.end(), v) - edges.begin();
        if (above == 0) continue;  // a logarithmic axis has no place for it
        const auto bin = std::min<std::ptrdiff_t>(above - 1, bins - 1);
        series.y[static_cast<std::size_t>(bin)] += 100.0 / static_cast<double>((f->*values).size());
      }
      panel.series.push_back(std::move(series));
    }
    return panel;
  }

  io::PlotPanel ranges() const {
    io::PlotPanel panel;
    panel.title = "Range of primaries";
    panel.x = energy_axis();
    panel.y.label = "nm";
    panel.y.log = true;
    for (std::size_t m = 0; m < options_.materials.size(); ++m) {
      io::PlotSeries depth, extent;
      const std::string& material = options_.materials[m].name;
      depth.name = material + ", mean depth";
      extent.name = material + ", 95 % stay within";
      for (const Findings* f : by_energy(m)) {
        depth.x.push_back(1e-3 * f->energy_ev);
        depth.y.push_back(mean(f->depth_nm));
        extent.y.push_back(percentile_of(f->extent_nm));
      }
      extent.x = depth.x;
      extent.dashed = true;
      depth.style = extent.style = io::PlotStyle::line_points;
      depth.color = extent.color = static_cast<int>(m);
      panel.series.push_back(std::move(depth));
      panel.series.push_back(std::move(extent));
    }
    return panel;
  }

  std::vector<const Findings*> by_energy(std::size_t material) const {
    std::vector<const Findings*> out;
    for (const Findings& f : findings)
      if (f.material == material) out.push_back(&f);
    std::sort(out.begin(), out.end(),
              [](const Findings* a, const Findings* b) { return a->energy_ev < b->energy_ev; });
    return out;
  }

  io::PlotPanel yields(const char* title, const char* label,
                       std::vector<mc::Estimate> Findings::*estimates, bool backscattered) const {
    io::PlotPanel panel;
    panel.title = title;
    if (several()) panel.x = energy_axis();
    else panel.x.label = "tilt (degrees)";
    panel.y.label = label;
    for (std::size_t m = 0; m < options_.materials.size(); ++m) {
      const auto found = by_energy(m);
      if (several())
        for (std::size_t t = 0; t < tilts_deg_.size(); ++t) {
          io::PlotSeries series = empty(m, t == 0);
          if (tilts_deg_.size() > 1) series.name += fmt::format(", {:g} degrees", tilts_deg_[t]);
          for (const Findings* f : found) add(series, 1e-3 * f->energy_ev, (f->*estimates)[t]);
          panel.series.push_back(std::move(series));
        }
      else {
        io::PlotSeries series = empty(m, true);
        for (std::size_t t = 0; t < tilts_deg_.size(); ++t)
          add(series, tilts_deg_[t], (found.front()->*estimates)[t]);
        panel.series.push_back(std::move(series));
      }
      io::PlotSeries measured = measurements(m, backscattered);
      if (!measured.x.empty()) panel.series.push_back(std::move(measured));
    }
    return panel;
  }

  io::PlotSeries empty(std::size_t material, bool solid) const {
    io::PlotSeries series;
    series.name = options_.materials[material].name;
    series.style = io::PlotStyle::line_points;
    series.color = static_cast<int>(material);
    series.dashed = !solid;
    return series;
  }

  static void add(io::PlotSeries& series, double x, const mc::Estimate& e) {
    series.x.push_back(x);
    series.y.push_back(e.mean);
    series.y_error.push_back(e.standard_error);
  }

  // The measured yields at normal incidence in the range of energies shown.
  io::PlotSeries measurements(std::size_t m, bool backscattered) const {
    io::PlotSeries series;
    if (std::find(tilts_deg_.begin(), tilts_deg_.end(), 0.0) == tilts_deg_.end()) return series;
    const mc::Material& material = options_.materials[m];
    const std::string element = material.constituents.size() == 1
                                    ? mc::element(material.constituents[0].atomic_number).symbol
                                    : material.name;
    const auto [low, high] =
        std::minmax_element(options_.energies_ev.begin(), options_.energies_ev.end());
    for (const MeasuredYield& y : options_.measured) {
      if (y.backscattered != backscattered ||
          (y.material != material.name && y.material != element))
        continue;
      if (y.energy_ev < 0.95 * *low || y.energy_ev > 1.05 * *high) continue;
      series.x.push_back(several() ? 1e-3 * y.energy_ev : 0);
      series.y.push_back(y.yield);
    }
    series.name = material.name + ", measured";
    series.style = io::PlotStyle::points;
    series.color = static_cast<int>(m);
    return series;
  }

  const LibraryPlotOptions& options_;
  std::size_t cascades_;
  std::vector<double> tilts_deg_;
};

void check(const LibraryPlotOptions& o) {
  if (o.materials.empty() || o.materials.size() > most_materials)
    throw UsageError("`library.materials`",
                     fmt::format("{} materials do not fit into one chart", o.materials.size()),
                     "Choose 1 to 8");
  if (o.energies_ev.empty())
    throw UsageError("`library.energy`", "there is none", "Give one or several");
  if (o.cascades < 1) throw UsageError("`library.cascades`", "there are none", "Ask for 10000");
}

// Options for one pixel, averaged over a whole library of about this size.
mc::SimulationOptions simulation_of(const LibraryPlotOptions& o) {
  mc::SimulationOptions options;
  options.method = mc::Method::replay;
  options.budget = mc::Accuracy{std::min(1.0, 3 / std::sqrt(static_cast<double>(o.cascades)))};
  options.library_memory = 0;  // no larger library
  options.seed = o.seed;
  options.threads = o.threads;
  return options;
}

// Finds the yields of a flat specimen, averaged over all cascades of the library.
void find_yields(const LibraryPlotOptions& o, double tilt_deg, mc::LibrarySource& libraries,
                 Findings& findings) {
  mc::Specimen specimen;
  specimen.materials = {o.materials[findings.material]};
  specimen.substrate = mc::Substrate{};
  mc::Beam beam;
  beam.energy_ev = findings.energy_ev;
  beam.tilt_deg = tilt_deg;
  mc::Scan scan;
  scan.width = scan.height = 1;
  const mc::SimulationResult result =
      mc::simulate(mc::Scene(specimen, beam, scan, o.physics), simulation_of(o),
                   {.watch = {{}, o.watch.cancel}, .libraries = &libraries});
  if (!result.complete) throw Interrupted();
  findings.se.push_back(result.yield(0, 0, 0));
  findings.bse.push_back(result.yield(1, 0, 0));
}

std::vector<double> tilts_of(const LibraryPlotOptions& o) {
  if (!o.tilts_deg.empty()) return o.tilts_deg;
  if (o.energies_ev.size() > 1) return {0};
  return {0, 15, 30, 45, 60, 75};
}

}  // namespace

void describe(ParameterVisitor& visit, LibraryPlotOptions& o) {
  const Parameter tilt{.name = "library.tilt",
                       .help = "Angles that yields are shown for",
                       .unit = Unit::deg,
                       .limits = from_to_below(0, 90),
                       .otherwise = "0; with one energy 0 to 75 degrees",
                       .form = "ANGLE,..."};
  visit.form(
      tilt, [&] { return fmt::format("{}", fmt::join(o.tilts_deg, ",")); },
      [&](std::string_view text, const std::string& subject) {
        o.tilts_deg = parse_values(text, tilt, subject);
      });
}

io::Plot plot_libraries(const LibraryPlotOptions& o, mc::LibrarySource& libraries) {
  const Watch& watch = o.watch;
  check(o);
  const std::vector<double> tilts_deg = tilts_of(o);
  const std::size_t cascades = mc::library_size(simulation_of(o), 0);
  Charts charts(o, cascades, tilts_deg);
  const double total = static_cast<double>(o.materials.size() * o.energies_ev.size());
  for (std::size_t m = 0; m < o.materials.size(); ++m) {
    for (const double energy_ev : o.energies_ev) {
      const auto done = static_cast<double>(charts.findings.size());
      const mc::Medium medium = mc::make_medium(o.materials[m], o.physics);
      const auto library =
          libraries.library({o.materials[m], o.physics, energy_ev + medium.barrier_ev(), o.seed},
                            cascades, o.threads, watch.part(done / total, (done + 0.8) / total));
      mc::CascadeStatistics statistics = mc::describe(*library, cascades);
      Findings found;
      found.material = m;
      found.energy_ev = energy_ev;
      found.depth_nm = std::move(statistics.primary_depth_nm);
      found.extent_nm = std::move(statistics.primary_extent_nm);
      for (const double tilt_deg : tilts_deg) find_yields(o, tilt_deg, libraries, found);
      charts.findings.push_back(std::move(found));
    }
  }
  return charts.plot();
}

}  // namespace surf::workflow
