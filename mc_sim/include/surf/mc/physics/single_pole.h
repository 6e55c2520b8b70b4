// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/physics/dielectric_data.h"

namespace surf::mc {

/// Inelastic scattering by the energy-loss function extended to momenta by a single pole (Penn,
/// Phys. Rev. B 35, 482 (1987), doi:10.1103/PhysRevB.35.482): a loss w0 of light becomes the
/// dispersion w_q^2 = w0^2 + kF^2 q^2 / 3 + q^4 / 4 of a free-electron gas whose plasma energy is
/// w0. Energies count from the bottom of the band.
class SinglePole {
 public:
  SinglePole(const EnergyLossFunction& elf, const BandLimits& limits);

  /// 1 / lambda, per nm, at a kinetic energy.
  double inverse_mean_free_path_per_nm(double energy_ev) const;
  /// Mean loss per length, eV/nm, of whichever electron is faster after the event: electrons cannot
  /// be told apart, and formulas of stopping powers take the faster one for the primary.
  double stopping_power_ev_per_nm(double energy_ev) const;

  /// How likely a loss is that begins at w0, per nm and per relative width of w0: integrates over
  /// ln w0 to 1 / lambda.
  double density_per_nm(double energy_ev, double w0_ev) const;

  /// Momenta, in atomic units, that an electron of this energy (hartree) may hand over with a loss
  /// that begins at w0; empty where first > last.
  struct Momenta {
    double first = 1, last = 0;
  };
  Momenta momenta(double energy, double w0) const;
  /// The loss at a momentum, hartree.
  static double loss(double w0, double momentum);

  const EnergyLossFunction& elf() const { return elf_; }
  const BandLimits& limits() const { return limits_; }

 private:
  template <class F>
  double over_losses(double energy_ev, const F& value) const;

  EnergyLossFunction elf_;
  BandLimits limits_;
};

}  // namespace surf::mc
