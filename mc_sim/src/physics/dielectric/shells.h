// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "surf/mc/physics/dielectric_data.h"

namespace surf::mc {

/// The inner shells behind an energy-loss function. Above a shell's binding energy its share is
/// what exceeds the continuation of the function from below the edge, as w^-3.5: the optical
/// absorption of what is bound less. Where the f-sum of the valence electrons is used up, it is all
/// of inner shells.
class Shells {
 public:
  explicit Shells(const DielectricData& data);

  /// The binding energy of the shell that a loss of light at w0 ionizes, eV below the highest
  /// filled state; 0: a valence electron. `u` uniform in [0, 1). `loss_ev`: what is lost in fact.
  double draw(double w0_ev, double loss_ev, double u) const;
  /// Of inner shells alone, one that a loss can ionize.
  double draw_inner(double loss_ev, double u) const;
  /// How likely it is not a valence electron.
  double share(double w0_ev, double loss_ev) const;

  /// The shell from which electrons fall into a hole of this binding energy, 0: from the valence
  /// band.
  double next_ev(double binding_ev) const;

  double lowest_ev() const { return shells_.empty() ? 1e30 : shells_.front().binding_ev; }

 private:
  struct Shell {
    double binding_ev;
    double below;  // the function below the edge
  };
  double deepest(double most_ev) const;

  EnergyLossFunction elf_;
  double gap_ev_, exhausted_ev_;
  std::vector<Shell> shells_;  // rising
};

}  // namespace surf::mc
