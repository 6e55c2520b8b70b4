// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What sweeps of the simulator have in common.

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../scenes.h"
#include "surf/mc/cascades/library_source.h"
#include "surf/mc/results/result_summary.h"
#include "surf/mc/simulate.h"

namespace surf::limits {

inline constexpr double none = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::size_t se = 0, bse = 1;  // the default detectors

/// Libraries of cascades that all sweeps share: they depend on material, energy and seed alone.
inline mc::LibrarySource& cascades() {
  static mc::FreshLibraries kept;
  return kept;
}

inline mc::SimulationResult simulate(const mc::Scene& scene, mc::Method method,
                                     std::int64_t electrons, std::uint64_t seed = 1) {
  mc::SimulationOptions options;
  options.method = method;
  options.budget = mc::ElectronsPerPixel{electrons};
  options.seed = seed;
  return mc::simulate(scene, options, {.libraries = &cascades()});
}

/// The mean over the image with its standard error, the library's share included.
inline mc::Estimate mean_yield(const mc::SimulationResult& r, std::size_t detector) {
  return mc::summarize(r).yields.at(detector);
}

inline double energy_unbalanced(const mc::Balance& b) {
  const double in = b.incident_energy.ev() + b.generated_energy.ev();
  return std::abs(in - b.escaped_energy.ev() - b.deposited_energy.ev() - b.lost_energy.ev()) / in;
}

/// Electrons that were given up, of all.
inline double share_lost(const mc::Balance& b) {
  return static_cast<double>(b.total_lost()) / static_cast<double>(b.incident + b.generated);
}

/// How far two SE images are from each other, and how far two that differ by chance alone would be:
/// root mean square over the pixels, of the first one's mean.
struct Apart {
  double rms, chance;
};
inline Apart apart(const mc::SimulationResult& a, const mc::SimulationResult& b) {
  double squares = 0, variance = 0, sum = 0;
  for (int y = 0; y < a.pixels.height(); ++y)
    for (int x = 0; x < a.pixels.width(); ++x) {
      const mc::Estimate p = a.yield(se, x, y), q = b.yield(se, x, y);
      squares += (p.mean - q.mean) * (p.mean - q.mean);
      variance += p.standard_error * p.standard_error + q.standard_error * q.standard_error;
      sum += p.mean;
    }
  const double n = static_cast<double>(a.pixels.size());
  return {std::sqrt(squares / n) / (sum / n), std::sqrt(variance / n) / (sum / n)};
}

/// Silicon without a substrate, with one body.
inline mc::Specimen body(TriangleMesh mesh) {
  mc::Specimen s = bench::only_silicon();
  s.bodies.push_back({"body", std::move(mesh), 0});
  return s;
}

}  // namespace surf::limits
