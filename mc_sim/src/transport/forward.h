// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/mc/transport/observer.h"

namespace surf::mc {

/// Passes the transport loop's events on to an Observer.
struct Forward {
  Observer& to;
  void begin_track(int n, int parent, int generation, const Vec3& p, const Vec3& d, double e) {
    to.begin_track(n, parent, generation, p, d, e);
  }
  void segment(const Vec3& a, const Vec3& b, double ea, double eb, int m) {
    to.segment(a, b, ea, eb, m);
  }
  void deposit(const Vec3& a, const Vec3& b, double e) { to.deposit(a, b, e); }
  void scattered(bool, double) {}
  void end_track(TrackKind end, const Vec3& p, const Vec3& d, double e) {
    to.end_track(end, p, d, e);
  }
};

}  // namespace surf::mc
