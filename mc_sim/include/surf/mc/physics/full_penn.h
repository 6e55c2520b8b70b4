// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "surf/mc/physics/dielectric_data.h"

namespace surf::mc {

/// The energy-loss function extended to momenta by the full Penn algorithm (Penn, Phys. Rev. B 35,
/// 482 (1987), doi:10.1103/PhysRevB.35.482; Shinotsuka et al., Surf. Interface Anal. 47, 871
/// (2015), doi:10.1002/sia.5789): a sum over free-electron gases of all plasma energies w_p, each
/// with the weight g(w_p) = 2 ELF(w_p) / (pi w_p) and Lindhard's dielectric function. A gas loses
/// to its plasmon, a line, and to pairs of an electron and a hole, a continuum. Kept as a table of
/// losses and momenta.
class FullPenn {
 public:
  /// Makes the table: about a second. Losses below the gap are left out.
  explicit FullPenn(const DielectricData& data);

  /// 1 / lambda, per nm, at an energy from the bottom of the band.
  double inverse_mean_free_path_per_nm(double energy_ev) const;
  /// Mean loss per length, eV/nm, of whichever electron is faster after the event (see SinglePole).
  double stopping_power_ev_per_nm(double energy_ev) const;
  /// The part of 1 / lambda between two losses.
  double between_per_nm(double energy_ev, double from_ev, double to_ev) const;

  /// Im[-1 / eps] at a loss and a momentum in atomic units, by its parts.
  struct Parts {
    double plasmon = 0, pairs = 0;
    double inner = 0;  ///< of both, what ionizes an inner shell
  };
  Parts value(double loss, double momentum) const;

  struct Table;
  const Table& table() const { return *table_; }

 private:
  std::shared_ptr<const Table> table_;
};

}  // namespace surf::mc
