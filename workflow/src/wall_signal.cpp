// SPDX-License-Identifier: GPL-3.0-or-later
#include "wall_signal.h"

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {
namespace {

// Beyond that electrons from the scanned part hardly come back.
constexpr double heights_around = 4, least_around_nm = 200;

}  // namespace

WallSignal simulate_wall(const FeatureShape& shape, const WallSimulation& how,
                         mc::LibrarySource& libraries, const Watch& watch) {
  mc::Beam beam;
  beam.energy_ev = how.energy_ev;
  beam.spot_nm = how.spot_nm;
  const mc::Medium medium = mc::make_medium(how.material, how.physics);
  const double last_u = how.first_u_nm + how.step_nm * (how.places - 1),
               scanned = std::max(std::abs(how.first_u_nm), std::abs(last_u)),
               around = scanned + std::max({least_around_nm, 2 * mc::reach_nm(medium, beam),
                                            heights_around * shape.wall.height_nm});
  mc::Specimen specimen;
  specimen.materials = {how.material};
  specimen.bodies.push_back({name(shape.kind), feature_mesh(shape, around), 0});
  mc::Scan scan;
  scan.width = how.places;
  scan.height = 1;
  scan.pixel_x_nm = scan.pixel_y_nm = how.step_nm;
  // Seen from the right wall's middle the material of a line lies at smaller x.
  const bool line = shape.kind == FeatureKind::line;
  const double wall = shape.kind == FeatureKind::edge ? 0 : 0.5 * shape.width_nm,
               middle_u = 0.5 * (how.first_u_nm + last_u);
  scan.center_x_nm = line ? wall - middle_u : wall + middle_u;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{how.electrons};
  options.seed = how.seed;
  options.threads = how.threads;
  options.method = mc::can_replay(medium) ? mc::Method::replay : mc::Method::direct;
  const mc::SimulationResult result =
      mc::simulate(mc::Scene(specimen, beam, scan, how.physics), options,
                   {.watch = watch, .libraries = &libraries});
  if (!result.complete) throw Interrupted();
  const std::size_t detector = how.signal == "BSE" ? 1 : 0;  // of the default ones
  WallSignal out;
  for (int k = 0; k < how.places; ++k) {
    const auto yield = result.yield(detector, line ? how.places - 1 - k : k, 0);
    out.mean.push_back(yield.mean);
    out.standard_error.push_back(yield.standard_error);
  }
  return out;
}

}  // namespace surf::workflow
