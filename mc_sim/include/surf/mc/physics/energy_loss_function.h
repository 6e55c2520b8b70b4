// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surf::mc {

/// The energy-loss function Im(-1/epsilon(w)) of a solid for light, as it was measured: at energies
/// (> 0, rising, eV), each with its value (>= 0). Between them logarithms are interpolated. Beyond
/// the last one it falls as it does over the last decade.
class EnergyLossFunction {
 public:
  /// Throws InvalidInput for fewer than three points, energies that do not rise, and values that
  /// are negative or not finite.
  EnergyLossFunction(std::vector<double> energies_ev, std::vector<double> values,
                     std::vector<double> shells_ev = {}, std::string source = {});

  /// The value at an energy, 0 or more. Below the first energy it falls as w.
  double operator()(double energy_ev) const;

  /// Where nothing is lost to electrons any more: what lies below an insulator's gap are vibrations
  /// of the lattice.
  EnergyLossFunction above(double gap_ev) const;

  /// That of the same substance with so many times the density, where single electrons and not
  /// their sum absorb.
  EnergyLossFunction times(double factor) const;

  double lowest_ev() const { return energies_.front(); }
  double highest_ev() const { return energies_.back(); }
  const std::vector<double>& energies_ev() const { return energies_; }
  const std::vector<double>& values() const { return values_; }
  /// Binding energies of outer shells, eV.
  const std::vector<double>& shells_ev() const { return shells_; }
  const std::string& source() const { return source_; }

  /// (2 / pi) times the integral of ELF / w: 1 for a metal, 1 - 1/epsilon(0) for an insulator
  /// (Kramers and Kronig).
  double screening_sum() const;
  /// The effective number of electrons that a density of formula units gives, from the integral of
  /// w ELF: the sum over their Z.
  double electron_sum(double formula_units_per_nm3) const;
  /// The loss below which that sum reaches a number of electrons; infinite where it never does.
  double loss_of_electrons_ev(double electrons, double formula_units_per_nm3) const;

 private:
  std::vector<double> energies_, values_, shells_;
  std::string source_;
  double cut_ev_ = 0;  // below it is nothing
  double slope_ = 0;   // d ln ELF / d ln w beyond the last energy
};

/// Reads "# ...source : TEXT", "# SHELL SHELL ... -1" and lines "energy_eV,ELF". `name` is for
/// messages. Throws InvalidInput with the line.
EnergyLossFunction parse_energy_loss_function(std::string_view text, const std::string& name);

}  // namespace surf::mc
