// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/single_pole.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dielectric/atomic_units.h"
#include "physics/dielectric/pole_line.h"

namespace surf::mc {
namespace {

using atomic::bohr_nm;
using atomic::hartree_ev;

constexpr int steps_per_octave = 48;  // of w0
constexpr double least_loss_ev = 1e-3;
constexpr int most_iterations = 60;

}  // namespace

SinglePole::SinglePole(const EnergyLossFunction& elf, const BandLimits& limits)
    : elf_(limits.gap_ev > 0 ? elf.above(limits.gap_ev) : elf), limits_(limits) {}

double SinglePole::loss(double w0, double q) { return PoleLine(w0).loss(q); }

// Momentum is conserved where q lies between the difference and the sum of the momenta p and p'
// before and after, which is where h(q) = (p^2 - p'^2 + q^2) / 2 - p q is not positive. h is
// convex: Newton's steps from outside approach its zeros from outside.
SinglePole::Momenta SinglePole::momenta(double energy, double w0) const {
  const double most = energy - (limits_.filled_ev + limits_.gap_ev) / hartree_ev;  // of losses
  if (!(most > w0)) return {};
  const PoleLine line(w0);
  const double before = atomic::momentum(energy);
  const auto zero = [&](double q, double side, double& at) {
    for (int i = 0; i < most_iterations; ++i) {
      const double w = line.loss(q);
      const double h =
          w * (1 + (energy - 0.5 * w) / atomic::rest_energy) + 0.5 * q * q - before * q;
      const double slope = line.slope(q, w) * (1 + (energy - w) / atomic::rest_energy) + q - before;
      if (slope * side >= 0) return false;  // beyond the minimum: there is none
      const double step = h / slope;
      q -= step;
      if (std::fabs(step) <= 1e-14 * q) break;
    }
    at = q;
    return true;
  };
  Momenta m;
  if (!zero(0.5 * w0 / before, 1, m.first) || !zero(2 * before, -1, m.last)) return {};
  m.last = std::min(m.last, line.momentum(most));
  return m;
}

double SinglePole::density_per_nm(double energy_ev, double w0_ev) const {
  const double value = elf_(w0_ev);
  if (!(value > 0)) return 0;
  const double energy = energy_ev / hartree_ev, w0 = w0_ev / hartree_ev;
  const Momenta m = momenta(energy, w0);
  if (!(m.last > m.first)) return 0;
  return value * w0 * w0 * PoleLine(w0).integral(m.first, m.last) /
         (std::numbers::pi * atomic::half_squared_speed(energy) * bohr_nm);
}

template <class F>
double SinglePole::over_losses(double energy_ev, const F& value) const {
  const double most_ev = energy_ev - limits_.filled_ev - limits_.gap_ev;
  const double least_ev = std::max(limits_.gap_ev, least_loss_ev);
  if (!(most_ev > least_ev)) return 0;
  const double from = std::log(least_ev), to = std::log(most_ev);
  const int steps =
      std::max(8, static_cast<int>(steps_per_octave * (to - from) / std::numbers::ln2));
  const double h = (to - from) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += h * value(std::exp(from + (i + 0.5) * h));  // dw0 = w0 d ln w0
  return sum;
}

double SinglePole::inverse_mean_free_path_per_nm(double energy_ev) const {
  return over_losses(energy_ev, [&](double w0_ev) { return density_per_nm(energy_ev, w0_ev); });
}

double SinglePole::stopping_power_ev_per_nm(double energy_ev) const {
  const double energy = energy_ev / hartree_ev;
  const double most = energy - (limits_.filled_ev + limits_.gap_ev) / hartree_ev;
  const double sum = over_losses(energy_ev, [&](double w0_ev) {
    const double value = elf_(w0_ev), w0 = w0_ev / hartree_ev;
    if (!(value > 0)) return 0.0;
    const Momenta m = momenta(energy, w0);
    if (!(m.last > m.first)) return 0.0;
    const PoleLine line(w0);
    // Up to half of what can be lost the loss counts, beyond it the rest.
    const double half =
        w0 < 0.5 * most ? std::clamp(line.momentum(0.5 * most), m.first, m.last) : m.first;
    return value * w0 * w0 *
           (std::log(half / m.first) + most * line.integral(half, m.last) -
            std::log(m.last / half));
  });
  return sum / (std::numbers::pi * atomic::half_squared_speed(energy)) / bohr_nm * hartree_ev;
}

}  // namespace surf::mc
