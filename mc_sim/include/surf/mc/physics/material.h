// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "surf/mc/physics/dielectric_data.h"
#include "surf/mc/physics/estimated_value.h"

namespace surf::mc {

/// One element of a material.
struct Constituent {
  int atomic_number = 0;          ///< Z; elastic tables exist for the Z that `has_mott_table` knows
  double atomic_weight = 0;       ///< g/mol, > 0
  double weight_fraction = 1;     ///< of the material's mass, in (0, 1]; they sum to 1
  double mean_ionization_ev = 0;  ///< J of the Joy-Luo loss, > 0
};

/// A homogeneous, isotropic solid. Energies inside are kinetic energies above the bottom of the
/// conduction band, with `inelastic=dielectric` above that of the filled band; outside they count
/// from the vacuum level. Plain data; `validate` checks it.
struct Material {
  std::string name;
  double density_g_cm3 = 0;  ///< > 0
  std::vector<Constituent> constituents;
  double formula_weight_g_mol = 0;  ///< of what `valence_electrons` counts for: SiO2, one Si atom
  double work_function_ev = 0;      ///< W: highest filled level to vacuum, > 0
  double barrier_ev = 0;            ///< U0: bottom of the conduction band to vacuum, >= 0
  double valence_electrons = 0;     ///< in `formula_weight_g_mol`, for Moeller scattering, >= 0
  double plasmon_ev = 0;            ///< bulk plasmon energy, 0: no plasmon events
  double loss_join_ev = 0;          ///< E_b: below it the loss continues as E^(5/2), > U0 + 1 eV
  bool loss_join_fitted = false;    ///< whether E_b was fitted to measured SE yields
  std::string sources;              ///< where the numbers come from
  std::vector<EstimatedValue> estimates;  ///< which of the numbers are estimates, and how
  std::shared_ptr<const DielectricData>
      dielectric;  ///< for `inelastic=dielectric`; never null once `complete` has made it
  bool taken_for_metal = false;  ///< W or U0 are estimated as a metal's, since no gap was given
};

/// Throws InvalidInput naming the material and the field.
void validate(const Material& material);

/// Atoms per nm^3 of one constituent.
double number_density_per_nm3(const Material& material, const Constituent& constituent);

/// Atoms of one constituent in the formula unit.
double atoms_per_formula_unit(const Material& material, const Constituent& constituent);

/// Formula units per nm^3.
double formula_units_per_nm3(const Material& material);

/// Whether the built-in Mott tables hold this element.
bool has_mott_table(int atomic_number);

}  // namespace surf::mc
