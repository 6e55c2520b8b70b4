// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/core/track.h"
#include "surf/core/vec3.h"

namespace surf::mc {

/// Watches one thread's electrons, told of each step as it happens (surf/mc/transport/observer.h
/// says what of). It is part of the loop, so that a loop that nobody watches costs nothing.
template <class W>
concept Watcher = requires(W watcher, int number, const Vec3& v, double energy_ev, bool isotropic,
                           TrackKind end) {
  watcher.begin_track(number, number, number, v, v, energy_ev);
  watcher.segment(v, v, energy_ev, energy_ev, number);
  watcher.deposit(v, v, energy_ev);
  watcher.scattered(isotropic, energy_ev);
  watcher.end_track(end, v, v, energy_ev);
};

/// Stands in where nobody watches.
struct NoObserver {
  void begin_track(int, int, int, const Vec3&, const Vec3&, double) {}
  void segment(const Vec3&, const Vec3&, double, double, int) {}
  void deposit(const Vec3&, const Vec3&, double) {}
  void scattered(bool, double) {}
  void end_track(TrackKind, const Vec3&, const Vec3&, double) {}
};

}  // namespace surf::mc
