// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "surf/core/random.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// What one scattering event did. Angles are relative to the electron's direction before it.
struct ScatterEvent {
  double cos_theta = 1;       ///< deflection of the electron
  double turn = 0;            ///< azimuth of the deflection in turns, [0, 1)
  bool isotropic = false;     ///< all directions alike: the two above count from any axis
  double energy_loss_ev = 0;  ///< debited from the electron (0 where the continuous loss pays)
  bool has_secondary = false;
  double secondary_energy_ev = 0;     ///< counted as the electron's
  Vec3 secondary_direction{0, 0, 1};  ///< unit; z is the electron's direction before the event
  double auger_energy_ev =
      0;  ///< of an electron that carries off the energy of an inner shell's hole; 0: none
  Vec3 auger_direction{0, 0, 1};  ///< likewise
};

/// A kind of event that happens at points along an electron's path: elastic scattering, a collision
/// with a valence electron, a plasmon ... Energies count from the bottom of the conduction band, or
/// from the vacuum level where the barrier is off. One class per mechanism, in a file of its own.
class Scattering {
 public:
  virtual ~Scattering() = default;

  /// Name, formula's source and range, for people.
  virtual std::string describe() const = 0;

  /// Events per nm at this energy (>= 0, finite); read once per energy bin when a medium is set up.
  virtual double inverse_mean_free_path_per_nm(double energy_ev) const = 0;

  /// Mean energy handed to secondaries per nm, eV, above the level they come from. The continuous
  /// loss has to pay for it (see make_medium).
  virtual double secondary_power_ev_per_nm(double /*energy_ev*/) const { return 0; }

  /// Whether the mechanism stands for all losses that no other mechanism accounts for, so that its
  /// rate is raised until the secondaries take up the whole continuous loss.
  virtual bool takes_remaining_loss() const { return false; }

  /// Whether an event may take energy from the electron (`energy_loss_ev`). Cascades of electrons
  /// that lose energy in steps cannot be joined where energies are equal (`can_replay`).
  virtual bool debits() const = 0;

  /// Draws one event. A secondary never has more energy than the electron that made it.
  /// Called only where the rate is positive somewhere in the energy's bin; where
  /// it is zero at this very energy, leave `event` as it is.
  virtual void scatter(double energy_ev, RandomStream& random, ScatterEvent& event) const = 0;
};

/// Energy lost steadily along the path.
class ContinuousLoss {
 public:
  virtual ~ContinuousLoss() = default;
  virtual std::string describe() const = 0;

  /// eV per nm (>= 0, finite).
  virtual double stopping_power_ev_per_nm(double energy_ev) const = 0;
};

}  // namespace surf::mc
