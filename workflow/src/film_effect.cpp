// SPDX-License-Identifier: GPL-3.0-or-later
#include "film_effect.h"

#include <cmath>
#include <numbers>

#include "surf/core/error.h"
#include "surf/mc/simulate.h"
#include "surf/mesh/height_field_mesh.h"

namespace surf::workflow {
namespace {

constexpr double thickness_nm = 2;
constexpr double tilts_deg[] = {0, 25, 40, 50, 60, 70, 80};

/// The specimen's plane under the film's.
TriangleMesh plane_below(double depth_nm) {
  constexpr double half_nm = 1000;
  HeightField field{{2 * half_nm, 2 * half_nm, -half_nm, -half_nm}, Grid<double>(2, 2, -depth_nm)};
  return height_field_sheet(field);
}

mc::Scene plane(const FilmRequest& request, double tilt_deg, bool with_film) {
  mc::Specimen specimen;
  specimen.materials = {with_film ? request.film : request.specimen};
  specimen.substrate = mc::Substrate{};
  if (with_film) {
    specimen.materials.push_back(request.specimen);
    specimen.bodies.push_back({"specimen", plane_below(thickness_nm), 1});
  }
  mc::Beam beam;
  beam.energy_ev = request.energy_ev;
  beam.tilt_deg = tilt_deg;
  mc::Scan scan;
  scan.width = scan.height = 1;
  return mc::Scene(specimen, beam, scan, request.physics);
}

}  // namespace

FilmEffect film_effect(const FilmRequest& request, const std::vector<std::string>& channels,
                       const Watch& watch) {
  mc::SimulationOptions options;
  options.method = mc::Method::direct;
  options.budget = mc::ElectronsPerPixel{request.electrons};
  options.seed = request.seed;
  options.threads = request.threads;
  constexpr int tilts = std::size(tilts_deg);
  std::vector<std::vector<FilmPoint>> points(channels.size());
  for (int i = 0; i < tilts; ++i) {
    const auto simulated = [&](bool with_film) {
      const double done = 2 * i + (with_film ? 1 : 0), all = 2 * tilts;
      mc::SimulationResult result =
          mc::simulate(plane(request, tilts_deg[i], with_film), options,
                       {.watch = watch.part(done / all, (done + 1) / all)});
      if (!result.complete) throw Interrupted();
      return result;
    };
    const mc::SimulationResult bare = simulated(false), covered = simulated(true);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const std::size_t detector = channels[c] == "BSE" ? 1 : 0;  // of the default ones
      const mc::Estimate from = bare.yield(detector, 0, 0), to = covered.yield(detector, 0, 0);
      const double ratio = to.mean / from.mean;
      points[c].push_back(
          {std::cos(tilts_deg[i] * std::numbers::pi / 180), (ratio - 1) / thickness_nm,
           ratio * std::hypot(to.standard_error / to.mean, from.standard_error / from.mean) /
               thickness_nm});
    }
  }
  FilmEffect effect{request.film.name, {}};
  for (const std::vector<FilmPoint>& of_channel : points)
    effect.per_nm.push_back(fit_film_effect(of_channel));
  return effect;
}

}  // namespace surf::workflow
