// SPDX-License-Identifier: GPL-3.0-or-later
// Fits E_b (loss_join_ev), the one free parameter of the secondary-electron model, to the geometric
// mean of the measured SE yields at 1 keV, and prints the yields that follow at other energies.
//   fit_loss_join MEASUREMENTS.csv [electrons]
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"

namespace {

using namespace surf;

// Geometric means of the measured yields by element and energy in keV.
std::map<std::string, std::map<double, double>> read_means(const char* path) {
  std::ifstream in(path);
  std::map<std::string, std::map<double, std::vector<double>>> all;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::stringstream fields(line);
    std::string element, z, energy, yield;
    std::getline(fields, element, ',');
    std::getline(fields, z, ',');
    std::getline(fields, energy, ',');
    std::getline(fields, yield, ',');
    // 1.02 keV and the like were meant as the round number beside them.
    all[element][std::round(std::stod(energy) * 20) / 20].push_back(std::log(std::stod(yield)));
  }
  std::map<std::string, std::map<double, double>> means;
  for (const auto& [element, energies] : all)
    for (const auto& [energy, logs] : energies) {
      double sum = 0;
      for (const double l : logs) sum += l;
      means[element][energy] = std::exp(sum / static_cast<double>(logs.size()));
    }
  return means;
}

mc::Balance simulate_flat(const mc::Material& material, double energy_ev, std::int64_t electrons) {
  mc::Specimen specimen;
  specimen.materials = {material};
  specimen.substrate = mc::Substrate{};
  mc::Beam beam;
  beam.energy_ev = energy_ev;
  mc::Scan scan;
  scan.width = scan.height = 1;
  mc::SimulationOptions options;
  options.electrons = electrons;
  return mc::simulate(mc::Scene(specimen, beam, scan), options).balance;
}

double se_yield(const mc::Balance& b) {
  return static_cast<double>(b.se) / static_cast<double>(b.incident);
}

// The yield grows with E_b: bisection.
double fit(mc::Material material, double target, std::int64_t electrons) {
  double low = std::fmax(material.barrier_ev, material.work_function_ev) + 1.01, high = 200;
  while (high - low > 0.02) {
    material.loss_join_ev = 0.5 * (low + high);
    (se_yield(simulate_flat(material, 1000, electrons)) < target ? low : high) =
        material.loss_join_ev;
  }
  return 0.5 * (low + high);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: fit_loss_join MEASUREMENTS.csv [electrons]\n");
    return 2;
  }
  const std::int64_t electrons = argc > 2 ? std::atoll(argv[2]) : 200000;
  const auto means = read_means(argv[1]);
  for (mc::Material material : io::builtin_materials()) {
    const auto measured = means.find(material.name);
    if (measured == means.end() || !measured->second.contains(1.0)) {
      fmt::print("{}: no measurements at 1 keV\n", material.name);
      continue;
    }
    material.loss_join_ev = fit(material, measured->second.at(1.0), electrons);
    fmt::print("{}: E_b = {:.1f} eV\n", material.name, material.loss_join_ev);
    for (const auto& [energy, yield] : measured->second) {
      if (energy < 0.1) continue;
      const mc::Balance b = simulate_flat(material, energy * 1000, electrons / 4);
      fmt::print("  {:6.2f} keV  SE {:.3f}  measured {:.3f}  ratio {:.2f}  BSE {:.3f}\n", energy,
                 se_yield(b), yield, se_yield(b) / yield,
                 static_cast<double>(b.bse) / static_cast<double>(b.incident));
    }
  }
}
