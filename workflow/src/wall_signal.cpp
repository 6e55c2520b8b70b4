// SPDX-License-Identifier: GPL-3.0-or-later
#include "wall_signal.h"

#include <algorithm>
#include <cmath>

#include "surf/core/error.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/simulate.h"
#include "surf/profile/profile_library.h"
#include "surf/reconstruction/view.h"
#include "surf/workflow/signal_detectors.h"

namespace surf::workflow {
namespace {

// Beyond that electrons from the scanned part hardly come back.
constexpr double heights_around = 4, least_around_nm = 200;
// Deviation of electrons about a place where the spot is wider, over the places' distance: at
// points, a signal that jumps, as at the edge of a wall that the beam does not see, would do so in
// whole steps.
constexpr double about_place = 0.5;

/// What a blur makes of a signal; at each side as many places are lost as it reaches.
WallSignal blurred(const WallSignal& sharp, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  WallSignal out;
  for (int u = reach; u + reach < static_cast<int>(sharp.mean.size()); ++u) {
    double mean = 0, variance = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = weights[static_cast<std::size_t>(std::abs(k))];
      const auto at = static_cast<std::size_t>(u + k);
      mean += weight * sharp.mean[at];
      variance += std::pow(weight * sharp.standard_error[at], 2);
    }
    out.mean.push_back(mean);
    out.standard_error.push_back(std::sqrt(variance));
  }
  return out;
}

}  // namespace

double blurred_by_nm(const WallSimulation& how) {
  if (how.spot_nm < how.step_nm) return 0;
  const double drawn = about_place * how.step_nm;
  return std::sqrt(how.spot_nm * how.spot_nm - drawn * drawn);
}

WallSignal simulate_wall(const FeatureShape& shape, const WallSimulation& how,
                         mc::LibrarySource& libraries, const Watch& watch) {
  if (const double blur_nm = blurred_by_nm(how); blur_nm > 0) {
    // The spot as a sum of neighbours leaves a quarter of the noise that drawing from it does.
    const std::vector<double> weights = blur_weights(blur_nm / how.step_nm);
    const int reach = static_cast<int>(weights.size()) - 1;
    WallSimulation sharp = how;
    sharp.spot_nm = about_place * how.step_nm;
    sharp.first_u_nm -= reach * how.step_nm;
    sharp.places += 2 * reach;
    return blurred(simulate_wall(shape, sharp, libraries, watch), weights);
  }
  mc::Beam beam;
  beam.energy_ev = how.energy_ev;
  beam.spot_nm = how.spot_nm;
  beam.tilt_deg = how.tilt_deg, beam.azimuth_deg = how.azimuth_deg;
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
  const bool smaller = (shape.kind == FeatureKind::line) != how.left;
  const double half = shape.kind == FeatureKind::edge ? 0 : 0.5 * shape.width_nm,
               wall = how.left ? -half : half, middle_u = 0.5 * (how.first_u_nm + last_u);
  const BeamAxes axes = beam_axes(how.tilt_deg, how.azimuth_deg);
  const Vec3 middle =
      Vec3{wall, 0, 0.5 * shape.wall.height_nm} + axes.across * (smaller ? -middle_u : middle_u);
  scan.center_x_nm = middle.x, scan.center_y_nm = middle.y;
  if (how.tilt_deg > 0) scan.center_z_nm = middle.z;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{how.electrons};
  options.seed = how.seed;
  options.threads = how.threads;
  options.detectors = mc::default_detectors();
  for (const mc::Detector& own : detectors_of(how.signal, "signal"))
    options.detectors.push_back(own);
  options.method = mc::can_replay(medium) ? mc::Method::replay : mc::Method::direct;
  // A grid of distances costs a shape of few electrons more than it saves.
  const mc::SimulationResult result =
      mc::simulate(mc::Scene(specimen, beam, scan, how.physics, {.distance_grid_bytes = 0}),
                   options, {.watch = watch, .libraries = &libraries});
  if (!result.complete) throw Interrupted();
  const std::size_t detector = how.signal == "SE" ? 0 : how.signal == "BSE" ? 1 : 2;
  WallSignal out;
  for (int k = 0; k < how.places; ++k) {
    const auto yield = result.yield(detector, smaller ? how.places - 1 - k : k, 0);
    out.mean.push_back(yield.mean);
    out.standard_error.push_back(yield.standard_error);
  }
  return out;
}

}  // namespace surf::workflow
