// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "surf/mc/physics/dielectric_data.h"
#include "surf/mc/physics/material.h"

namespace surf::mc {

/// What is known of a material for `inelastic=dielectric`; `complete` estimates the rest.
struct DielectricDraft {
  std::optional<EnergyLossFunction> elf;
  std::optional<double>
      elf_density_g_cm3;  ///< of what it was measured on, where that is not the material's
  std::optional<double> filled_band_ev, gap_ev, vacuum_ev;
  std::optional<double>
      refractive_index;  ///< of visible light, for the screening sum of an insulator
  std::optional<double> lattice_nm, resistivity_ohm_m, effective_mass, density_of_states_mass;
  std::vector<AcousticBranch> acoustic;
  std::optional<std::vector<OpticalMode>> optical;
  double trap_per_nm = 0, trap_ev = 0;
  std::string sources;
};

/// All that simulations need, with what is missing estimated from a complete `material` and listed
/// in `estimates`:
/// - gap_ev: the material's W - U0, 0 where that is negative; vacuum_ev: its W;
/// - filled_band_ev: of a metal its U0 - W, of others the Fermi energy of a gas of its valence
/// electrons;
/// - elf: scaled where it is of another density; without one see `estimated_energy_loss_function`;
/// - lattice_nm: of a face-centred cubic lattice of its atoms; sound: 5000 m/s;
/// - deformation potentials: by the resistivity, or without it so that phonons at 100 eV turn
/// electrons round as atoms do;
/// - optical modes of compounds with a gap: one of 0.1 eV, permittivity above it (95 eV /
/// gap)^(1/2) by Moss's rule, below it
///   1.6 times that.
/// Throws InvalidInput naming the field.
std::shared_ptr<const DielectricData> complete(const DielectricDraft& draft,
                                               const Material& material);

/// A valence band's plasmon at the material's `plasmon_ev`, or that of a gas of its valence
/// electrons where that is larger, half as wide as high in energy; and above an edge what falls as
/// w^-4. Both fulfil the f-sum, the valence electrons and all others, and the edge lies so that the
/// mean logarithm of losses is that of the mean ionization energy J.
EnergyLossFunction estimated_energy_loss_function(const Material& material);

}  // namespace surf::mc
