// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/physics/energy_loss_function.h"

namespace surf::mc {

/// Where energies of electrons inside count from, and which losses the filled states forbid.
struct BandLimits {
  double filled_ev = 0;   ///< from the bottom of the band to the highest filled state: F of a metal, the valence width of others
  double gap_ev = 0;      ///< 0 for metals: no smaller loss, and no final state within it
};

/// Inelastic scattering by the energy-loss function extended to momenta by a single pole (Penn, Phys. Rev. B 35, 482 (1987),
/// doi:10.1103/PhysRevB.35.482): a loss w0 of light becomes the dispersion w_q^2 = w0^2 + kF^2 q^2 / 3 + q^4 / 4 of a
/// free-electron gas whose plasma energy is w0. Energies count from the bottom of the band.
class SinglePole {
 public:
  SinglePole(const EnergyLossFunction& elf, const BandLimits& limits);

  /// 1 / lambda, per nm, at a kinetic energy.
  double inverse_mean_free_path_per_nm(double energy_ev) const { return integral(energy_ev, false); }
  /// Mean loss per length, eV/nm.
  double stopping_power_ev_per_nm(double energy_ev) const { return integral(energy_ev, true); }

  /// Momenta, in atomic units, that an electron of this energy (hartree) may hand over with a loss that begins at w0; empty
  /// where first > last.
  struct Momenta {
    double first = 1, last = 0;
  };
  Momenta momenta(double energy, double w0) const;
  /// The loss at a momentum, hartree.
  static double loss(double w0, double momentum);

 private:
  double integral(double energy_ev, bool weighted) const;

  EnergyLossFunction elf_;
  BandLimits limits_;
};

}  // namespace surf::mc
