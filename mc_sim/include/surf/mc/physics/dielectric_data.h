// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "surf/mc/physics/energy_loss_function.h"
#include "surf/mc/physics/estimated_value.h"

namespace surf::mc {

/// Where energies of electrons inside count from, and which losses the filled states forbid.
struct BandLimits {
  double filled_ev = 0;  ///< from the bottom of the band to the highest filled state: F of a metal,
                         ///< the valence width of others
  double gap_ev = 0;     ///< 0 for metals: no smaller loss, and no final state within it

  /// Where electrons can be that move: F of a metal, the bottom of the conduction band of others.
  double free_ev() const { return filled_ev + gap_ev; }
};

/// One or more branches of acoustic phonons that are alike.
struct AcousticBranch {
  double speed_m_s = 0;
  double deformation_ev = 0;  ///< how strongly it moves the band; 0: as the resistivity says, or to
                              ///< join Mott's transport
  double bend_m2_s = 0;       ///< alpha of w = c k - alpha k^2; 0: estimated
  int count = 1;
};

/// A longitudinal optical mode, which polarises: Froehlich's coupling is 1 / high_permittivity - 1
/// / low_permittivity.
struct OpticalMode {
  double energy_ev = 0;
  double high_permittivity = 1, low_permittivity = 1;  ///< above the mode and below it
};

/// What simulations with `inelastic=dielectric` know of a material. They count energies from the
/// bottom of the filled band.
struct DielectricData {
  EnergyLossFunction elf;
  BandLimits band;
  double exhausted_ev =
      0;  ///< beyond it the valence electrons' part of the f-sum is used up: shells below absorb
  double vacuum_ev =
      0;  ///< from the highest filled state to the vacuum: W of a metal, gap and affinity of others

  double lattice_nm = 0;
  std::vector<AcousticBranch> acoustic;
  double resistivity_ohm_m = 0;       ///< of a metal, for its deformation potential; 0: unknown
  double effective_mass = 1;          ///< of the electron's, in acoustic scattering
  double density_of_states_mass = 1;  ///< likewise
  std::vector<OpticalMode> optical;
  double trap_per_nm = 0;  ///< P of polaron traps, 1 / lambda = P exp(-E / E_t); 0: none
  double trap_ev = 0;      ///< E_t; E counts from the bottom of the conduction band

  double expected_screening_sum =
      1;  ///< of a complete energy-loss function: 1, and of an insulator 1 - 1/n^2
  std::string sources;
  std::vector<EstimatedValue> estimates;

  double barrier_ev() const { return band.filled_ev + vacuum_ev; }
};

/// The text of an energy-loss function that comes with semsurf, "Si" for data/elf/Si.csv; empty
/// where there is none.
std::string_view find_energy_loss_file(std::string_view name);

}  // namespace surf::mc
