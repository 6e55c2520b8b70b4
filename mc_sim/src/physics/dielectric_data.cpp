// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/dielectric_data.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "physics/elf_data.h"
#include "surf/core/error.h"

namespace surf::mc {
namespace {

struct Known {
  const char* material;
  const char* file;
  double filled_ev, gap_ev;   // filled 0: to be estimated
  const char* source;
  double screening_sum;
};

// Fermi energies of metals, or widths of valence bands, and gaps. Refractive indices for screening sums: Si 3.4, Ge 4, SiO2 1.46,
// TiO2 2.5, PMMA 1.49.
constexpr Known known[] = {
    {"Si", "Si", 7.27, 1.12, "valence band and gap as in Nebula's silicon", 0.914},
    {"SiO2", "SiO2", 20, 9, "valence band: JMONSEL; gap as in Nebula's", 0.531},
    {"C", "GlassyCarbon", 20.4, 0, "JMONSEL", 1},
    {"graphite", "Graphite", 20.4, 0, "JMONSEL", 1},
    {"Al", "Al", 11.7, 0, "Fermi energy as in Nebula's aluminium", 1},
    {"Cu", "Cu", 7.0, 0, "Fermi energy as in Nebula's copper: free electrons", 1},
    {"Au", "Au", 5.53, 0, "Fermi energy as in Nebula's gold: free electrons", 1},
    {"Ag", "Ag", 5.49, 0, "Fermi energy of free electrons, a handbook's", 1},
    {"W", "W", 10.1, 0, "JMONSEL", 1},
    {"Ge", "Ge", 12.6, 0.67, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled; a handbook's gap", 0.9375},
    {"Ti", "Ti", 6.0, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"TiO2", "TiO2", 0, 3.0, "a handbook's gap", 0.84},
    {"Cr", "Cr", 7.8, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"Ni", "Ni", 9.1, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"Mo", "Mo", 6.5, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"Pt", "Pt", 10.6, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"Fe", "Fe", 8.9, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"Ta", "Ta", 8.4, 0, "width of the valence band in Tanuma, Powell and Penn's calculations, recalled", 1},
    {"PMMA", "PMMA", 0, 5.6, "gap as in Nebula's", 0.55},
};

const Known* find(const std::string& material) {
  const auto* const found = std::ranges::find_if(known, [&](const Known& k) { return k.material == material; });
  return found == std::end(known) ? nullptr : found;
}

// hbar^2 (3 pi^2 n)^(2/3) / 2 m.
double free_electron_fermi_ev(double electrons_per_nm3) { return 0.364627 * std::pow(electrons_per_nm3, 2.0 / 3); }

}  // namespace

std::optional<DielectricData> find_dielectric_data(const Material& material) {
  const Known* const k = find(material.name);
  if (!k) return std::nullopt;
  const auto files = elf_files();
  const auto file = std::ranges::find(files, std::string_view(k->file), &ElfFile::name);
  if (file == files.end()) throw InvalidInput(k->file, "this energy-loss function is not in the library", "Build it again");
  DielectricData data{parse_energy_loss_function(file->text, k->file), {k->filled_ev, k->gap_ev}, k->source};
  if (k->filled_ev == 0) {
    const double electrons = material.valence_electrons * formula_units_per_nm3(material);
    data.band.filled_ev = free_electron_fermi_ev(electrons);
    data.band_source = fmt::format("{}width of the filled band estimated: a gas of {:g} free electrons per formula unit",
                                   *k->source ? fmt::format("{}; ", k->source) : "", material.valence_electrons);
  }
  return data;
}

double expected_screening_sum(const Material& material) {
  const Known* const k = find(material.name);
  return k ? k->screening_sum : 1;
}

}  // namespace surf::mc
