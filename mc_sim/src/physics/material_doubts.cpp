// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/material_doubts.h"

#include <fmt/format.h>

#include <algorithm>

#include "surf/mc/physics/element.h"

namespace surf::mc {
namespace {

constexpr int hydrogen = 1, carbon = 6;
constexpr int insulating[] = {7, 8, 9, 15, 16, 17, 33, 34, 35, 52, 53};
constexpr double least_share = 0.25;  // of the atoms: less is an alloy's

bool has_carbon(const Material& m) {
  return std::ranges::any_of(m.constituents,
                             [](const Constituent& c) { return c.atomic_number == carbon; });
}

/// The symbols of those elements that make most compounds insulators; empty where there are few
/// such atoms.
std::string insulating_elements(const Material& m) {
  if (m.constituents.size() < 2) return {};
  const bool organic = has_carbon(m);
  double share = 0, atoms = 0;
  std::string symbols;
  for (const Constituent& c : m.constituents) {
    const double n = atoms_per_formula_unit(m, c);
    atoms += n;
    const bool counts = std::ranges::find(insulating, c.atomic_number) != std::end(insulating) ||
                        (organic && c.atomic_number == hydrogen);
    if (!counts) continue;
    share += n;
    symbols += (symbols.empty() ? "" : " and ") + std::string(element(c.atomic_number).symbol);
  }
  return share >= least_share * atoms ? symbols : std::string();
}

}  // namespace

std::optional<std::string> doubt_of_a_metal(const Material& m) {
  const std::string symbols = m.taken_for_metal ? insulating_elements(m) : std::string();
  if (symbols.empty()) return std::nullopt;
  return fmt::format(
      "{}: it is taken for a metal, as its band_gap_ev is not given, but most compounds with {} "
      "are "
      "insulators or semiconductors. Its barrier of {:.3g} eV, and so its yield, may be far off. "
      "Give "
      "band_gap_ev, or 0 if it is a metal",
      m.name, symbols, m.barrier_ev);
}

std::vector<std::string> doubts(const Material& m) {
  std::vector<std::string> out;
  if (const auto doubt = doubt_of_a_metal(m)) out.push_back(*doubt);
  std::string fields;
  for (const EstimatedValue& e : m.estimates)
    if (e.field != "loss_join_ev") fields += (fields.empty() ? "" : ", ") + e.field;
  if (!fields.empty())
    out.push_back(fmt::format(
        "{}: these numbers are estimates: {}. 'semsurf materials {}' tells how they are made; give "
        "those that you know",
        m.name, fields, m.name));
  return out;
}

}  // namespace surf::mc
