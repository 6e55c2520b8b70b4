// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/dielectric/measured_reach.h"

#include <algorithm>
#include <cmath>

#include "physics/directions.h"
#include "surf/core/random.h"
#include "surf/core/vec3.h"

namespace surf::mc {
namespace {

constexpr std::size_t electrons = 3000;
constexpr double first_ev = 1, last_ev = 512;  // above the vacuum level
constexpr double straight = 1.2;               // longer than the mean way of a straight electron
constexpr double wanted_decades = 6, safety = 1.1;
constexpr std::uint64_t seed = 1;
constexpr int most_steps = 100000;

struct Electron {
  Vec3 position, direction;
  double energy_ev;
};

// The greatest distance of a cascade from its start.
double extent_nm(const Medium& medium, double energy_ev, RandomStream& random,
                 std::vector<Electron>& waiting) {
  double squared = 0;
  waiting.assign(1, {{}, {0, 0, -1}, energy_ev});
  while (!waiting.empty()) {
    Electron e = waiting.back();
    waiting.pop_back();
    for (int step = 0; step < most_steps && e.energy_ev > medium.cutoff_ev(); ++step) {
      e.position += e.direction * medium.step(e.energy_ev, -std::log(random.uniform())).length_nm;
      squared = std::max(squared, dot(e.position, e.position));
      ScatterEvent event;
      medium.choose(e.energy_ev, random.uniform()).scatter(e.energy_ev, random, event);
      const auto free = [&](double energy, const Vec3& local) {
        if (energy > medium.cutoff_ev())
          waiting.push_back({e.position, from_frame_of(e.direction, local), energy});
      };
      if (event.has_secondary) free(event.secondary_energy_ev, event.secondary_direction);
      if (event.auger_energy_ev > 0) free(event.auger_energy_ev, event.auger_direction);
      e.direction = event.isotropic ? from_axis(event.cos_theta, event.turn)
                                    : deflected(e.direction, event.cos_theta, event.turn);
      e.energy_ev -= event.energy_loss_ev;
    }
  }
  return std::sqrt(squared);
}

double measure_nm(const Medium& medium, double energy_ev, std::uint64_t number) {
  std::vector<double> extents;
  std::vector<Electron> waiting;
  for (std::size_t i = 0; i < electrons; ++i) {
    RandomStream random(seed, number, i);
    extents.push_back(extent_nm(medium, energy_ev, random, waiting));
  }
  std::ranges::sort(extents, std::greater<>());
  const double tenth = extents[electrons / 10], hundredth = extents[electrons / 100],
               thousandth = extents[electrons / 1000];
  const double per_decade = std::max(hundredth - tenth, 0.5 * (thousandth - tenth));
  return hundredth + (wanted_decades - 2) * safety * per_decade;
}

}  // namespace

std::vector<double> measured_reach_nm(
    const Medium& medium, const std::function<double(double)>& stopping_power_ev_per_nm) {
  std::vector<double> energies, reaches;
  const double zero = std::max(medium.barrier_ev(), medium.cutoff_ev());
  double most = 0;
  for (double above = first_ev; above <= last_ev; above *= 2) {
    energies.push_back(zero + above);
    reaches.push_back(most = std::max(most, measure_nm(medium, energies.back(), energies.size())));
  }
  std::vector<double> out;
  for (int i = 0; i <= EnergyBins::count; ++i) {
    const double energy = EnergyBins::lower_ev(i);
    if (energy <= medium.cutoff_ev()) {
      out.push_back(0);
    } else if (energy <= energies.back()) {  // as far as the next higher one that was measured
      out.push_back(reaches[static_cast<std::size_t>(std::ranges::lower_bound(energies, energy) -
                                                     energies.begin())]);
    } else {
      const double before = std::max(energies.back(), EnergyBins::lower_ev(i - 1));
      const double way = (energy - before) / stopping_power_ev_per_nm(0.5 * (before + energy));
      out.push_back(std::max(out.back(), reaches.back()) + straight * way);
    }
  }
  return out;
}

}  // namespace surf::mc
