// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "surf/core/random.h"
#include "surf/mc/physics/dielectric_data.h"

namespace surf::mc {

/// A loss to electrons, in atomic units.
struct Loss {
  double energy = 0;    ///< that the electron loses
  double momentum = 0;  ///< that it hands over
  double shell_ev =
      0;  ///< binding energy of the inner shell that it ionizes; 0: it goes to the valence band
  bool collective = false;  ///< a plasmon's
};

/// A way to extend an energy-loss function to momenta: how often electrons lose, and what. Energies
/// inside count from the bottom of the filled band.
class LossSampler {
 public:
  virtual ~LossSampler() = default;
  virtual double inverse_mean_free_path_per_nm(double energy_ev) const = 0;
  /// Mean loss per length of the faster electron (see SinglePole).
  virtual double stopping_power_ev_per_nm(double energy_ev) const = 0;
  /// False where nothing can be lost at this energy.
  virtual bool draw(double energy_ev, RandomStream& random, Loss& loss) const = 0;
  virtual std::size_t bytes() const = 0;
};

std::unique_ptr<const LossSampler> make_single_pole_sampler(const DielectricData& data);
std::unique_ptr<const LossSampler> make_full_penn_sampler(const DielectricData& data);

}  // namespace surf::mc
