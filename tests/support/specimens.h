// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "surf/io/sim/materials.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/shapes.h"

namespace surf::test {

/// A bare half-space of one of the built-in materials.
inline mc::Specimen flat(const char* material) {
  mc::Specimen specimen;
  specimen.materials = {io::find_material(material, "test")};
  specimen.substrate = mc::Substrate{};
  return specimen;
}

/// A box standing on z = 0 about the z axis.
inline TriangleMesh pillar(double width_nm, double height_nm) {
  const double half = 0.5 * width_nm;
  return make_box({-half, -half, 0}, {half, half, height_nm});
}

/// A scan of `pixels` x `pixels` over a square around the origin.
inline mc::Scan square_scan(double width_nm, int pixels) {
  mc::Scan scan;
  scan.width = scan.height = pixels;
  scan.pixel_x_nm = scan.pixel_y_nm = width_nm / pixels;
  return scan;
}

inline mc::SimulationResult simulate(const mc::Specimen& specimen, const mc::Beam& beam,
                                     const mc::Scan& scan, std::int64_t electrons,
                                     const mc::Physics& physics = {}, std::uint64_t seed = 1) {
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{electrons};
  options.seed = seed;
  return mc::simulate(mc::Scene(specimen, beam, scan, physics), options);
}

/// The default detectors, as numbered in every result.
inline constexpr std::size_t se = 0, bse = 1;

/// The default options with this seed.
inline mc::SimulationOptions seeded(std::uint64_t seed) {
  mc::SimulationOptions options;
  options.seed = seed;
  return options;
}

/// A detector's yield over all pixels.
inline mc::Estimate mean_yield(const mc::SimulationResult& result, std::size_t detector) {
  mc::Counts sum;
  std::int64_t primaries = 0;
  for (const mc::PixelTally& p : result.pixels.data()) primaries += p.primaries;
  for (const mc::Counts& c : result.counts[detector].data()) sum += c;
  return mc::estimate(primaries, sum);
}

struct Yields {
  mc::Estimate se, bse;
};

/// Yields over all pixels.
inline Yields yields(const mc::SimulationResult& result) {
  return {mean_yield(result, se), mean_yield(result, bse)};
}

/// Yields of a bare half-space.
inline Yields flat_yields(const char* material, double energy_ev, double tilt_deg,
                          std::int64_t electrons, const mc::Physics& physics = {}) {
  mc::Beam beam;
  beam.energy_ev = energy_ev;
  beam.tilt_deg = tilt_deg;
  return yields(simulate(flat(material), beam, square_scan(10, 1), electrons, physics));
}

}  // namespace surf::test
