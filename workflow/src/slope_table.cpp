// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/workflow/slope_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surf/core/error.h"
#include "surf/mc/cascades/cascade_library.h"
#include "surf/mc/geometry/field_in_reach.h"
#include "surf/mc/physics/medium.h"
#include "surf/mc/simulate.h"

namespace surf::workflow {
namespace {

constexpr double steepest_deg = 89;
constexpr double ranges_to_edge = 3;
/// Length of the floor in ranges. Beyond it the scene continues flat to twenty times that, much
/// farther than electrons from the slope land.
constexpr double floor_in_ranges = 40;
constexpr std::size_t se = 0, bse = 1;  // indices of the default detectors

void check(const SlopeTableOptions& o) {
  if (!(o.step_deg > 0 && std::isfinite(o.step_deg) && o.last_deg >= 0 &&
        o.last_deg <= steepest_deg))
    throw UsageError(
        "slope table",
        fmt::format("angles to {:g} in steps of {:g} degrees", o.last_deg, o.step_deg),
        fmt::format("Give steps above 0 and a last angle from 0 to {:g}", steepest_deg));
  if (o.electrons < 2)
    throw UsageError("slope table", fmt::format("{} electrons have no standard error", o.electrons),
                     "Give 2 or more");
}

/// Ground, slope and top along x; nothing changes along y. The beam's axis is at 0.
HeightField two_planes(double angle, double range_nm) {
  const double width = 2 * ranges_to_edge * range_nm * std::cos(angle),
               height = width * std::tan(angle);
  const int floor =
      std::max(2, static_cast<int>(std::ceil(floor_in_ranges * range_nm / width)) + 1);
  const int columns = floor + std::max(2, static_cast<int>(std::ceil(range_nm / width)) + 1);
  HeightField f;
  f.z_nm = Grid<double>(columns, 2);
  f.pitch_x_nm = width;
  f.pitch_y_nm = floor_in_ranges * range_nm;
  f.origin_x_nm = -(floor - 0.5) * width;  // the slope is between columns floor - 1 and floor
  f.origin_y_nm = -0.5 * f.pitch_y_nm;
  for (int y = 0; y < 2; ++y)
    for (int x = floor; x < columns; ++x) f.z_nm(x, y) = height;
  return f;
}

mc::Scene make_scene(const mc::Material& material, double energy_ev, double angle_deg,
                     const SlopeTableOptions& o) {
  mc::Beam beam;
  beam.energy_ev = energy_ev;
  mc::Scan scan;
  scan.width = scan.height = 1;
  mc::Specimen specimen;
  specimen.materials = {material};
  const double angle = angle_deg * std::numbers::pi / 180;
  if (o.specimen == SlopeSpecimen::single_plane || angle_deg == 0) {
    beam.tilt_deg = angle_deg;
    specimen.substrate = mc::Substrate{};
  } else {
    const double range = mc::reach_nm(mc::make_medium(material, o.physics), beam);
    specimen.height_field =
        mc::HeightFieldBody{"two planes", two_planes(angle, range), 0, Edge::flat};
  }
  return mc::Scene(specimen, beam, scan, o.physics);
}

}  // namespace

SlopeTable make_slope_table(const mc::Material& material, double energy_ev,
                            const SlopeTableOptions& o, mc::LibrarySource* libraries) {
  check(o);
  mc::FreshLibraries fresh;
  mc::SimulationOptions options;
  options.budget = mc::ElectronsPerPixel{o.electrons};
  options.seed = o.seed;
  options.threads = o.threads;
  options.method = mc::can_replay(mc::make_medium(material, o.physics)) ? mc::Method::replay
                                                                        : mc::Method::direct;
  SlopeTable table;
  table.step_deg = o.step_deg;
  // The added 5e-4 steps make 85 one of the angles, whatever the rounding of 17 x 5.
  const int angles = static_cast<int>(o.last_deg / o.step_deg + 5e-4) + 1;
  for (int i = 0; i < angles; ++i) {
    o.watch.check();
    const Watch part = o.watch.part(double(i) / angles, double(i + 1) / angles);
    const mc::Scene scene = make_scene(material, energy_ev, i * o.step_deg, o);
    const mc::SimulationResult result =
        mc::simulate(scene, options, {.watch = part, .libraries = libraries ? libraries : &fresh});
    if (!result.complete) throw Interrupted();
    table.se.push_back(result.yield(se, 0, 0));
    table.bse.push_back(result.yield(bse, 0, 0));
  }
  return table;
}

SlopeModelParameters to_slope_model(const SlopeTable& table) {
  SlopeModelParameters parameters;
  parameters.form = SlopeForm::table;
  parameters.table_step_deg = table.step_deg;
  const auto channel = [](const char* name, const std::vector<mc::Estimate>& yields) {
    SlopeChannel c;
    c.name = name;
    if (!yields.empty() && yields.front().mean > 0) c.flat_yield = yields.front().mean;
    for (const mc::Estimate& y : yields) c.yields.push_back(y.mean);
    return c;
  };
  parameters.channels = {channel("SE", table.se), channel("BSE", table.bse)};
  return parameters;
}

}  // namespace surf::workflow
