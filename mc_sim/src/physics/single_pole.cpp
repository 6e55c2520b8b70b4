// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/physics/single_pole.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace surf::mc {
namespace {

constexpr double hartree_ev = 27.211386246, bohr_nm = 0.0529177210903;
constexpr double rest_energy = 18778.865;   // of an electron, hartree
constexpr int steps_per_octave = 24;        // of w0

// Nodes and weights of Gauss and Legendre on [-1, 1], eight of them.
constexpr std::array<double, 4> nodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> weights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

// kF^2 / 3 of the electron gas whose plasma energy is w0.
double dispersion(double w0) {
  const double kf = std::cbrt(0.75 * std::numbers::pi * w0 * w0);
  return kf * kf / 3;
}

// Of the electron before and after a loss, relativistic: p^2 = 2 T (1 + T / 2 m c^2).
double momentum(double energy) { return std::sqrt(2 * energy * (1 + energy / (2 * rest_energy))); }

template <class F>
double bisect(double low, double high, const F& is_above) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (is_above(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

SinglePole::SinglePole(const EnergyLossFunction& elf, const BandLimits& limits)
    : elf_(limits.gap_ev > 0 ? elf.above(limits.gap_ev) : elf), limits_(limits) {}

double SinglePole::loss(double w0, double q) { return std::sqrt(w0 * w0 + dispersion(w0) * q * q + 0.25 * q * q * q * q); }

SinglePole::Momenta SinglePole::momenta(double energy, double w0) const {
  const double most = energy - (limits_.filled_ev + limits_.gap_ev) / hartree_ev;   // of losses
  if (!(most > w0)) return {};
  const double d = dispersion(w0);
  const double longest = std::sqrt(2 * (std::sqrt(d * d + most * most - w0 * w0) - d));   // where w_q is `most`
  // Momentum is conserved where q lies between the difference and the sum of the momenta before and after.
  const double before = momentum(energy);
  const auto room = [&](double q) {
    const double after = momentum(std::max(0.0, energy - loss(w0, q)));
    return std::min(q - (before - after), before + after - q);
  };
  // Somewhere in between there is room, or nowhere: the room grows up to there and falls beyond.
  double low = 0, high = longest;
  for (int i = 0; i < 100; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (room(a) < room(b) ? low : high) = room(a) < room(b) ? a : b;
  }
  const double best = 0.5 * (low + high);
  if (!(room(best) > 0)) return {};
  Momenta m;
  m.first = bisect(0, best, [&](double q) { return room(q) > 0; });
  m.last = room(longest) >= 0 ? longest : bisect(best, longest, [&](double q) { return room(q) < 0; });
  return m;
}

double SinglePole::integral(double energy_ev, bool weighted) const {
  const double energy = energy_ev / hartree_ev;
  const double most_ev = energy_ev - limits_.filled_ev - limits_.gap_ev;
  const double least_ev = std::max(limits_.gap_ev, 1e-3);
  if (!(most_ev > least_ev)) return 0;
  const double from = std::log(least_ev), to = std::log(most_ev);
  const int steps = std::max(8, static_cast<int>(steps_per_octave * (to - from) / std::numbers::ln2));
  const double h = (to - from) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double w0_ev = std::exp(from + (i + 0.5) * h), w0 = w0_ev / hartree_ev;
    const double value = elf_(w0_ev);
    if (!(value > 0)) continue;
    const Momenta m = momenta(energy, w0);
    if (!(m.last > m.first)) continue;
    const double middle = 0.5 * std::log(m.first * m.last), half = 0.5 * std::log(m.last / m.first);
    double over_momenta = weighted ? 2 * half : 0;
    for (std::size_t k = 0; k < nodes.size() && !weighted; ++k)
      for (const double sign : {-1.0, 1.0})
        over_momenta += half * weights[k] / loss(w0, std::exp(middle + sign * half * nodes[k]));
    sum += h * w0 * value * w0 * over_momenta;   // dw0 = w0 d ln w0
  }
  // 1 / (pi K), with m v^2 / 2 in place of K.
  const double gamma = 1 + energy / rest_energy;
  const double half_v2 = 0.5 * rest_energy * (1 - 1 / (gamma * gamma));
  const double per_bohr = sum / (std::numbers::pi * half_v2);
  return per_bohr / bohr_nm * (weighted ? hartree_ev : 1);
}

}  // namespace surf::mc
