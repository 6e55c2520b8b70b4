// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>

namespace surf::mc {

/// Lindhard's dielectric function of a free-electron gas (Kgl. Danske Videnskab. Selskab Mat.-Fys.
/// Medd. 28, no. 8 (1954)), atomic units, q > 0 and w > 0.
class Lindhard {
 public:
  /// Of the gas whose plasma energy is w_p.
  static Lindhard of_plasma_energy(double wp) {
    return Lindhard(std::cbrt(0.75 * std::numbers::pi * wp * wp));
  }
  static Lindhard of_log_plasma_energy(double log_wp) {
    static const double factor = std::cbrt(0.75 * std::numbers::pi);
    return Lindhard(factor * std::exp(2.0 / 3 * log_wp));
  }
  explicit Lindhard(double fermi_momentum) : k_(fermi_momentum) {}

  static double plasma_energy(double fermi_momentum) {
    return std::sqrt(4 * fermi_momentum * fermi_momentum * fermi_momentum / (3 * std::numbers::pi));
  }
  double fermi_momentum() const { return k_; }

  double real(double q, double w) const {
    const double z = 0.5 * q / k_, u = w / (q * k_);
    // Far from the continuum the logarithms nearly cancel: w_p^2 / w^2 is left, with two more terms
    // of its series.
    if (u > 50 * (1 + z)) {
      const double u2 = u * u, z2 = z * z;
      return 1 - scale(z) / (3 * u2) * (1 + (0.6 + z2) / u2);
    }
    return 1 + scale(z) * (0.5 + (part(z - u) + part(z + u)) / (8 * z));
  }
  double imaginary(double q, double w) const {
    const double z = 0.5 * q / k_, u = w / (q * k_), d = z - u;
    if (z + u < 1) return scale(z) * 0.5 * std::numbers::pi * u;
    return std::fabs(d) < 1 ? scale(z) * std::numbers::pi / (8 * z) * (1 - d * d) : 0;
  }

 private:
  double scale(double z) const { return 1 / (std::numbers::pi * k_ * z * z); }
  static double part(double d) {
    const double a = std::fabs(d + 1), b = std::fabs(d - 1);
    return a > 0 && b > 0 ? (1 - d * d) * std::log(a / b) : 0;
  }

  double k_;
};

}  // namespace surf::mc
