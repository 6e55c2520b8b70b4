// SPDX-License-Identifier: GPL-3.0-or-later
// Fits E_b (loss_join_ev), the one free parameter of the secondary-electron model, to the geometric
// mean of the measured SE yields at 1 keV, and prints the yields that follow at other energies;
// then the regression of E_b of all fitted materials on barrier and band gap, which estimates E_b
// of the others (mc::estimated_loss_join_ev).
//   fit_loss_join ELECTRONS MEASUREMENTS.csv... [--only NAME]...
//   e.g. fit_loss_join 200000 data/reference/se_delta_joy2001.csv
//   data/reference/se_yields_further.csv
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "measured_means.h"
#include "surf/mc/flat_yields.h"

namespace {

using namespace surf;

// The yield grows with E_b: bisection.
double fit(mc::Material material, double target, bool with_bse, std::int64_t electrons) {
  double low = std::fmax(material.barrier_ev, material.work_function_ev) + 1.01, high = 300;
  while (high - low > 1e-3 * low) {
    material.loss_join_ev = 0.5 * (low + high);
    const auto y = mc::flat_yields(material, 1000, electrons);
    (y.se.mean + (with_bse ? y.bse.mean : 0) < target ? low : high) = material.loss_join_ev;
  }
  return 0.5 * (low + high);
}

void print_other_energies(const mc::Material& material, const std::map<double, double>& measured,
                          bool with_bse, std::int64_t electrons) {
  for (const auto& [energy, yield] : measured) {
    if (energy < 0.1) continue;
    const auto y = mc::flat_yields(material, energy * 1000, electrons);
    const double own = y.se.mean + (with_bse ? y.bse.mean : 0);
    fmt::print("  {:6.2f} keV  {} {:.3f}  measured {:.3f}  ratio {:.2f}  BSE {:.3f}\n", energy,
               with_bse ? "SE+BSE" : "SE", own, yield, own / yield, y.bse.mean);
  }
}

double gap_ev(const mc::Material& m) { return std::fmax(m.work_function_ev - m.barrier_ev, 0); }

// ln E_b against ln (a U0 + b gap): a yield goes as a power of E_b, so relative errors count.
void print_regression(const std::vector<mc::Material>& materials) {
  double best = HUGE_VAL, best_a = 0, best_b = 0;
  for (double a = 4; a < 10; a += 0.01)
    for (double b = 0; b < 5; b += 0.01) {
      double sum = 0;
      for (const mc::Material& m : materials)
        sum += std::pow(std::log((a * m.barrier_ev + b * gap_ev(m)) / m.loss_join_ev), 2);
      if (sum < best) best = sum, best_a = a, best_b = b;
    }
  fmt::print("E_b = {:.2f} U0 + {:.2f} gap, relative deviations of {:.3f} (rms):\n", best_a, best_b,
             std::sqrt(best / double(materials.size())));
  for (const mc::Material& m : materials)
    fmt::print("  {:10} U0 {:6.2f}  gap {:5.2f}  fitted {:6.1f}  regression {:6.1f}\n", m.name,
               m.barrier_ev, gap_ev(m), m.loss_join_ev, best_a * m.barrier_ev + best_b * gap_ev(m));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: fit_loss_join ELECTRONS MEASUREMENTS.csv... [--only NAME]...\n");
    return 2;
  }
  const std::int64_t electrons = std::atoll(argv[1]);
  std::vector<std::string> files, only;
  for (int i = 2; i < argc; ++i) {
    if (std::string(argv[i]) == "--only" && i + 1 < argc) only.push_back(argv[++i]);
    else files.push_back(argv[i]);
  }
  const bench::Means means = bench::read_means(files, "delta");
  std::vector<mc::Material> fitted;
  for (mc::Material material : io::builtin_materials()) {
    const bool wanted =
        only.empty() || std::find(only.begin(), only.end(), material.name) != only.end();
    std::string key = bench::measured_as(material, means);
    const bool with_bse = !means.contains(key);
    if (with_bse) key = "SE+BSE of " + material.name;
    const auto measured = means.find(key);
    if (wanted && measured != means.end() && measured->second.contains(1.0)) {
      material.loss_join_ev = fit(material, measured->second.at(1.0), with_bse, electrons);
      material.loss_join_fitted = true;
      fmt::print("{}: E_b = {:.1f} eV\n", material.name, material.loss_join_ev);
      print_other_energies(material, measured->second, with_bse, electrons / 4);
    }
    if (material.loss_join_fitted) fitted.push_back(material);
    std::fflush(stdout);
  }
  print_regression(fitted);
}
