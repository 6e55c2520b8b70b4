// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

// Electrons in hartree and bohr, relativistic.
namespace surf::mc::atomic {

inline constexpr double hartree_ev = 27.211386246, bohr_nm = 0.0529177210903;
inline constexpr double rest_energy = 18778.865;  // of an electron, hartree

/// p^2 = 2 T (1 + T / 2 m c^2).
inline double squared_momentum(double energy) {
  return 2 * energy * (1 + energy / (2 * rest_energy));
}
inline double momentum(double energy) { return std::sqrt(squared_momentum(std::max(0.0, energy))); }
/// m v^2 / 2, which stands where the kinetic energy does in slower electrons' cross-sections.
inline double half_squared_speed(double energy) {
  const double gamma = 1 + energy / rest_energy;
  return 0.5 * rest_energy * (1 - 1 / (gamma * gamma));
}

}  // namespace surf::mc::atomic
