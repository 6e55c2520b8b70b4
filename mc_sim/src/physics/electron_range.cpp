// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/electron_range.h"

#include <fmt/format.h>

#include <cmath>

#include "surf/core/error.h"

namespace surf::mc {

double kanaya_okayama_range_nm(const Material& material, double energy_ev) {
  validate(material);
  if (!(energy_ev > 0 && std::isfinite(energy_ev)))
    throw InvalidInput("electron range", fmt::format("the energy is {} eV", energy_ev),
                       "Give an energy above 0");
  double atoms = 0, weight = 0, charge = 0;  // per gram, in moles
  for (const Constituent& c : material.constituents) {
    const double share = c.weight_fraction / c.atomic_weight;
    atoms += share;
    weight += share * c.atomic_weight;
    charge += share * c.atomic_number;
  }
  return 27.6 * (weight / atoms) * std::pow(1e-3 * energy_ev, 1.67) /
         (std::pow(charge / atoms, 0.89) * material.density_g_cm3);
}

}  // namespace surf::mc
