// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

#include "surf/core/vec3.h"
#include "transport/transport.h"

namespace surf::mc {

/// A Geometry (transport.h) of one material, number 0, without any surface.
struct Endless {
  using State = int;
  struct Surface {
    double distance = 0;
    Vec3 position, position_ahead, normal;
    State state_ahead = -1;
  };
  int material(State) const { return 0; }
  double clearance(const Vec3&) const { return std::numeric_limits<double>::infinity(); }
  double farthest() const { return std::numeric_limits<double>::infinity(); }
  bool flies_free(const Vec3&, const Vec3&) const { return true; }
  Crossing crossing(const Vec3&, const Vec3&, double, State&, Surface&) const {
    return Crossing::none;
  }
};

}  // namespace surf::mc
