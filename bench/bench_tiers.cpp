// SPDX-License-Identifier: GPL-3.0-or-later
// What each tier of physics costs, and how much images differ by it: tables of
// docs/explanation/dielectric.md.
//   bench_tiers [ELECTRONS] [--yields FILE.svg]
// Four scenes at 1 keV by both tiers, in turn; speeds are medians of three. An image of the tier
// `monsel` is scaled by the gain that fits that of `dielectric` best; what is left, its noise taken
// off, is a share of the mean. Beside it the noise of the comparison.
// --yields draws yields of twelve materials by both tiers, with the measurements in data/reference.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "scenes.h"
#include "surf/io/plot.h"
#include "surf/mc/flat_yields.h"
#include "surf/mc/simulate.h"
#include "surf/workflow/measured_yields.h"

namespace {

using namespace surf;

struct Case {
  const char* name;
  mc::Specimen specimen;
  mc::Scan scan;
};

mc::Scan scan(int width, int height, double pixel_nm) {
  mc::Scan s;
  s.width = width, s.height = height;
  s.pixel_x_nm = s.pixel_y_nm = pixel_nm;
  return s;
}

mc::Specimen with(const char* material, const TriangleMesh& mesh) {
  mc::Specimen s = bench::flat(bench::only_silicon());
  s.materials.push_back(io::find_material(material, "bench"));
  s.bodies.push_back({material, mesh, 1});
  return s;
}

std::vector<Case> cases() {
  mc::Specimen line = bench::only_silicon();
  line.height_field =
      mc::HeightFieldBody{"line", make_line({160, 40, 1}, 40, 40, 2), 0, Edge::flat};
  return {
      {"topography in one material: a mesa", bench::mesa(bench::only_silicon()), scan(48, 48, 6)},
      {"material contrast: gold beside silicon, level",
       with("Au", make_box({-400, -400, -60}, {0, 400, 0.001})), scan(64, 4, 1)},
      {"a thin film: the edge of 5 nm of SiO2 on silicon",
       with("SiO2", make_box({-400, -400, 0}, {0, 400, 5})), scan(64, 4, 1)},
      {"a line's edge: silicon, 40 nm high", line, scan(96, 4, 1)}};
}

struct Image {
  std::array<std::vector<mc::Estimate>, 2> yields;
  double direct_rate = 0, replay_rate = 0;
};

Image simulate(const Case& c, const char* tier, int electrons) {
  mc::Physics physics;
  mc::parse_physics(std::string("inelastic=") + tier, physics);
  mc::Beam beam;
  const mc::Scene scene(c.specimen, beam, c.scan, physics);
  mc::FreshLibraries libraries;
  Image image;
  mc::SimulationOptions options;
  options.seed = 1;
  std::vector<double> direct, replay;
  for (int i = 0; i < 3; ++i) {
    options.method = mc::Method::direct;
    options.budget = mc::ElectronsPerPixel{std::max(2, electrons / 60)};
    auto r = mc::simulate(scene, options);
    direct.push_back(double(r.balance.incident) / r.seconds);
    options.method = mc::Method::replay;
    options.budget = mc::ElectronsPerPixel{electrons};
    r = mc::simulate(scene, options, {.libraries = &libraries});
    replay.push_back(double(r.balance.incident) / r.seconds);
    if (i < 2) continue;
    for (std::size_t d = 0; d < 2; ++d)
      for (int y = 0; y < c.scan.height; ++y)
        for (int x = 0; x < c.scan.width; ++x) image.yields[d].push_back(r.yield(d, x, y));
  }
  std::ranges::sort(direct), std::ranges::sort(replay);
  image.direct_rate = direct[1], image.replay_rate = replay[1];
  return image;
}

struct Difference {
  double gain, rest, noise;
};

// Of the scaled image from the true one, as a share of its mean.
Difference difference(const std::vector<mc::Estimate>& truth,
                      const std::vector<mc::Estimate>& other) {
  double ab = 0, bb = 0, mean = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    ab += truth[i].mean * other[i].mean, bb += other[i].mean * other[i].mean, mean += truth[i].mean;
  const double gain = ab / bb, n = double(truth.size());
  mean /= n;
  double squares = 0, noise = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double d = truth[i].mean - gain * other[i].mean;
    squares += d * d / n;
    noise += (truth[i].standard_error * truth[i].standard_error +
              gain * gain * other[i].standard_error * other[i].standard_error) /
             n;
  }
  return {gain, std::sqrt(std::max(0.0, squares - noise)) / mean, std::sqrt(noise) / mean};
}

void compare(int electrons) {
  fmt::print(
      "| scene | SE: gain, what is left (noise) | BSE: gain, what is left (noise) | direct, monsel "
      "and dielectric /s | replay /s |\n"
      "|---|---|---|---|---|\n");
  for (const Case& c : cases()) {
    const Image monsel = simulate(c, "monsel", electrons),
                dielectric = simulate(c, "dielectric", electrons);
    fmt::print("| {} |", c.name);
    for (std::size_t d = 0; d < 2; ++d) {
      const Difference e = difference(dielectric.yields[d], monsel.yields[d]);
      fmt::print(" {:.2f}, {:.1f} % ({:.1f} %) |", e.gain, 100 * e.rest, 100 * e.noise);
    }
    fmt::print(" {:.3g}, {:.3g} | {:.3g}, {:.3g} |\n", monsel.direct_rate, dielectric.direct_rate,
               monsel.replay_rate, dielectric.replay_rate);
    std::fflush(stdout);
  }
}

void draw_yields(const std::string& file, int electrons) {
  constexpr double energies[] = {200, 300, 500, 800, 1000, 1500, 2000, 3000, 5000, 10000};
  std::vector<workflow::MeasuredYield> measured;
  for (const char* name : {"se_delta_joy2001.csv", "bse_eta_joy2001.csv", "se_yields_further.csv"})
    for (auto& y : workflow::read_measured_yields(std::string(SEMSURF_REFERENCE_DATA) + "/" + name))
      measured.push_back(y);
  io::Plot plot;
  plot.title = "Yields of planes";
  plot.columns = 3;
  for (const char* name :
       {"C", "Al", "Si", "Ge", "Cu", "Ni", "Ag", "W", "Au", "SiO2", "TiO2", "PMMA"}) {
    io::PlotPanel p;
    p.title = name;
    p.x = {"energy of the beam (eV)", true, {}};
    p.y = {"electrons per primary", true, {}};
    for (const char* tier : {"dielectric", "monsel"}) {
      mc::Physics physics;
      mc::parse_physics(std::string("inelastic=") + tier, physics);
      io::PlotSeries se, bse;
      se.name = std::string("SE, ") + tier, bse.name = std::string("BSE, ") + tier;
      for (const double e : energies) {
        const auto y = mc::flat_yields(io::find_material(name, "bench"), e,
                                       e > 2500 ? electrons / 4 : electrons, physics);
        se.x.push_back(e), se.y.push_back(y.se.mean);
        bse.x.push_back(e), bse.y.push_back(y.bse.mean);
      }
      se.color = 0, bse.color = 1;
      se.dashed = bse.dashed = std::string(tier) == "monsel";
      p.series.push_back(std::move(se)), p.series.push_back(std::move(bse));
    }
    for (const bool backscattered : {false, true}) {
      io::PlotSeries s;
      s.name = backscattered ? "BSE, measured" : "SE, measured";
      s.style = io::PlotStyle::points;
      s.color = backscattered ? 1 : 0;
      for (const auto& y : measured)
        if (y.material == name && y.backscattered == backscattered && y.energy_ev >= 190 &&
            y.energy_ev <= 10500)
          s.x.push_back(y.energy_ev), s.y.push_back(y.yield);
      if (!s.x.empty()) p.series.push_back(std::move(s));
    }
    plot.panels.push_back(std::move(p));
    fmt::print("{}\n", name);
  }
  io::write_plot(file, plot);
}

}  // namespace

int main(int argc, char** argv) {
  int electrons = 6000;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--yields" && i + 1 < argc) {
      draw_yields(argv[i + 1], electrons);
      return 0;
    }
    electrons = std::atoi(argv[i]);
  }
  compare(electrons);
}
