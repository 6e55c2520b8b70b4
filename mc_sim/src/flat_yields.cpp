// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/flat_yields.h"

#include "surf/core/error.h"
#include "surf/mc/simulate.h"

namespace surf::mc {
namespace {

constexpr int pixels = 4;  // to a side: units of work for the threads

}  // namespace

FlatYields flat_yields(const Material& material, double energy_ev, std::int64_t electrons,
                       const Physics& physics, int threads, const Watch& watch) {
  Specimen specimen;
  specimen.materials = {material};
  specimen.substrate = Substrate{};
  Beam beam;
  beam.energy_ev = energy_ev;
  Scan scan;
  scan.width = scan.height = pixels;
  SimulationOptions options;
  options.method = Method::direct;
  options.budget = ElectronsPerPixel{(electrons + pixels * pixels - 1) / (pixels * pixels)};
  options.tile_pixels = 1;
  options.threads = threads;
  const SimulationResult result =
      simulate(Scene(specimen, beam, scan, physics), options, {.watch = watch});
  if (!result.complete) throw Interrupted();
  const auto yield = [&](std::size_t detector) {
    Counts sum;
    for (const Counts& c : result.counts[detector].data()) sum += c;
    return estimate(result.balance.incident, sum);
  };
  return {yield(0), yield(1)};
}

}  // namespace surf::mc
