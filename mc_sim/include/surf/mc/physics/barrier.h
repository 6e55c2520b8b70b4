// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "surf/core/vec3.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

/// Probability that an electron gets over a potential step, from the energy `normal_ev` of its
/// motion along the normal and the height `step_ev` it has to climb (negative: it falls).
/// quantum: T = 4 k1 k2 / (k1 + k2)^2 of an abrupt step, k1 = sqrt(normal), k2 = sqrt(normal -
/// step) (Cohen-Tannoudji, Quantum Mechanics, H_I); classical: 1 where normal > step; off: 1.
inline double transmission(BarrierModel model, double normal_ev, double step_ev) {
  if (model == BarrierModel::off) return 1.0;
  if (normal_ev <= step_ev || normal_ev <= 0) return 0.0;
  if (model == BarrierModel::classical) return 1.0;
  const double k1 = std::sqrt(normal_ev);
  const double k2 = std::sqrt(normal_ev - step_ev);
  return 4.0 * k1 * k2 / ((k1 + k2) * (k1 + k2));
}

/// Takes an electron across a potential step, or reflects it; true if it got across. The tangential
/// momentum is kept: a crossing refracts, a reflection is specular. `normal` is a unit vector of
/// either sense. The one place where energy changes its zero. `random.uniform()` gives uniform
/// numbers in (0, 1).
template <class Random>
bool cross_barrier(BarrierModel model, const Vec3& normal, double step_ev, Vec3& direction,
                   double& energy_ev, Random& random) {
  if (model == BarrierModel::off || step_ev == 0.0) return true;
  const double cosine = dot(direction, normal);
  const double normal_ev = energy_ev * cosine * cosine;
  const double t = transmission(model, normal_ev, step_ev);
  if (t <= 0.0 || (t < 1.0 && random.uniform() >= t)) {
    direction = normalized(direction - normal * (2.0 * cosine));
    return false;
  }
  const Vec3 tangential = direction - normal * cosine;
  const double along = std::copysign(std::sqrt((normal_ev - step_ev) / energy_ev), cosine);
  direction = normalized(tangential + normal * along);
  energy_ev -= step_ev;
  return true;
}

}  // namespace surf::mc
