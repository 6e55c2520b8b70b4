// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "surf/core/track.h"
#include "surf/core/vec3.h"
#include "surf/mc/transport/tally.h"

namespace surf::mc {

/// Watches the transport loop: trajectories, spectra, cascade libraries and tests derive from it.
/// Calls come in the order in which things happen to one primary and its secondaries, on the
/// thread that simulates it. Energies inside matter count from the bottom of the conduction band.
class Observer {
 public:
  virtual ~Observer() = default;

  /// A primary starts on its way to the specimen (energy in vacuum).
  virtual void primary(std::int64_t /*pixel*/, std::int64_t /*electron*/) {}

  /// A track begins: generation 0 is the primary. Tracks of one primary are numbered from 0.
  virtual void begin_track(int /*track*/, int /*parent*/, int /*generation*/,
                           const Vec3& /*position_nm*/, const Vec3& /*direction*/,
                           double /*energy_ev*/) {}

  /// A straight piece of the current track; `material` is -1 in vacuum.
  virtual void segment(const Vec3& /*from_nm*/, const Vec3& /*to_nm*/, double /*energy_from_ev*/,
                       double /*energy_to_ev*/, int /*material*/) {}

  /// Energy left in the matter along the straight piece between two points (or at a point), eV.
  /// Negative where a secondary starts: secondaries are not debited from the electron that makes
  /// them but from what its continuous loss has left there. All of it adds up to the incident
  /// energy less what escaped and what was lost.
  virtual void deposit(const Vec3& /*from_nm*/, const Vec3& /*to_nm*/, double /*energy_ev*/) {}

  /// The current track ends, with its last energy: in vacuum for se, bse and transmitted.
  virtual void end_track(TrackKind /*end*/, const Vec3& /*position_nm*/, const Vec3& /*direction*/,
                         double /*energy_ev*/) {}
};

}  // namespace surf::mc
