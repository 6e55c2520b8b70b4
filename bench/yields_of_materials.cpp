// SPDX-License-Identifier: GPL-3.0-or-later
// The table of docs/development/materials_figures.md: SE and BSE yields of flat built-in materials
// at normal incidence, with one standard error, beside measurements and formulas.
//   yields_of_materials ELECTRONS DATA/reference [ENERGY_KEV...]
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "measured_means.h"
#include "surf/mc/flat_yields.h"

namespace {

using namespace surf;

// Hunger and Kuechler (1979) with August's factor (1989); E in keV. Made for 4 to 40 keV and not
// for hydrogen, which reflects next to nothing.
double august(int z, double e) {
  if (z == 1) return 0;
  const double l = std::log(z);
  const double c = 0.1904 - 0.2236 * l + 0.1292 * l * l - 0.01491 * l * l * l;
  const double m = 0.1382 - 0.9211 / std::sqrt(z);
  return c * std::pow(e, m) * (0.9987 + 2.167e-4 * z);
}

// Heinrich's rule for compounds: means by weight.
double august(const mc::Material& m, double e) {
  double sum = 0;
  for (const mc::Constituent& c : m.constituents)
    sum += c.weight_fraction * august(c.atomic_number, e);
  return sum;
}

std::string with_error(const mc::Estimate& e) {
  return fmt::format("{:.3f} ± {:.3f}", e.mean, e.standard_error);
}

std::optional<double> mean_near(const bench::Means& means, const std::string& key, double kev) {
  const auto found = means.find(key);
  if (found == means.end()) return {};
  const auto at = found->second.find(std::round(kev * 20) / 20);
  if (at == found->second.end()) return {};
  return at->second;
}

std::string or_none(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "";
}

// The universal curve of Lin and Joy (Surf. Interface Anal. 37, 895 (2005)) through a yield's
// maximum.
double universal(double maximum, double at_ev, double kev) {
  const double x = 1000 * kev / at_ev;
  return maximum * 1.28 * std::pow(x, -0.67) * (1 - std::exp(-1.614 * std::pow(x, 1.67)));
}

// What the handbook's maximum means at an energy; "0.900 to 1.200" where it gives a range.
std::string from_maximum(const std::string& path, const std::string& name, double kev) {
  std::ifstream in(path);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    const auto fields = io::split_csv_line(line);
    if (fields.size() > 2 && fields[0] == name)
      out += fmt::format("{}{:.2f}", out.empty() ? "" : " to ",
                         universal(std::stod(fields[1]), std::stod(fields[2]), kev));
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: yields_of_materials ELECTRONS DATA/reference [ENERGY_KEV...]\n");
    return 2;
  }
  const std::string folder = argv[2];
  std::vector<double> energies;
  for (int i = 3; i < argc; ++i) energies.push_back(std::atof(argv[i]));
  if (energies.empty()) energies = {1, 5, 20};
  const bench::Means se = bench::read_means(
      {folder + "/se_delta_joy2001.csv", folder + "/se_yields_further.csv"}, "delta");
  const bench::Means bse = bench::read_means({folder + "/bse_eta_joy2001.csv"}, "eta");
  fmt::print(
      "| material | keV | SE | measured | handbook | BSE | measured | formula |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const mc::Material& m : io::builtin_materials())
    for (const double e : energies) {
      const auto y = mc::flat_yields(m, 1000 * e, std::atoll(argv[1]));
      fmt::print("| {} | {:g} | {} | {} | {} | {} | {} | {:.3f} |\n", m.name, e, with_error(y.se),
                 or_none(mean_near(se, bench::measured_as(m, se), e)),
                 from_maximum(folder + "/se_maxima_handbook.csv", m.name, e), with_error(y.bse),
                 or_none(mean_near(bse, bench::measured_as(m, bse), e)), august(m, e));
      std::fflush(stdout);
    }
}
