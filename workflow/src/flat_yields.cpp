// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/flat_yields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surf/core/error.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {
namespace {

constexpr std::size_t se = 0, bse = 1;   // of the default detectors
constexpr int pixels = 16;               // along the scan, so that threads share the work

}  // namespace

mc::Estimate FlatYields::total() const { return {se.mean + bse.mean, std::hypot(se.standard_error, bse.standard_error)}; }

FlatYields flat_yields(const mc::Material& material, double energy_ev, const mc::Physics& physics, std::int64_t electrons,
                       int threads, const Watch& watch) {
  mc::Beam beam;
  beam.energy_ev = energy_ev;
  mc::Scan scan;
  scan.width = scan.height = pixels;
  scan.pixel_x_nm = scan.pixel_y_nm = 1;
  mc::Specimen specimen;
  specimen.materials = {material};
  specimen.substrate = mc::Substrate{};
  mc::SimulationOptions options;
  options.method = mc::Method::direct;
  options.budget = mc::ElectronsPerPixel{std::max<std::int64_t>(1, (electrons + pixels * pixels - 1) / (pixels * pixels))};
  options.threads = threads;
  const mc::Scene scene(specimen, beam, scan, physics);
  const mc::SimulationResult result = mc::simulate(scene, options, {.progress = watch.progress, .cancel = watch.cancel});
  if (!result.complete) throw Interrupted();
  FlatYields out;
  for (const auto& [detector, estimate] : {std::pair{se, &out.se}, std::pair{bse, &out.bse}}) {
    double sum = 0, squares = 0;
    for (int y = 0; y < pixels; ++y)
      for (int x = 0; x < pixels; ++x) {
        const mc::Estimate e = result.yield(detector, x, y);
        sum += e.mean;
        squares += e.mean * e.mean;
      }
    const double n = pixels * pixels, mean = sum / n;
    *estimate = {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
  }
  return out;
}

}  // namespace surf::workflow
