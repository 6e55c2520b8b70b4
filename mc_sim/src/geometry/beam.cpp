// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/beam.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/parameters.h"
#include "surf/core/units.h"
#include "surf/mc/geometry/largest_length.h"
#include "surf/mc/physics/physics.h"

namespace surf::mc {

namespace {
constexpr double most_convergence_deg = 20;
constexpr double most_azimuth_deg =
    3600;  // ten turns: far beyond, numbers no longer tell directions apart
constexpr double widest_scan =
    4;  // largest lengths: a tilted beam sees a box from corner to corner

}  // namespace

Vec3 direction(const Beam& beam) {
  const double t = beam.tilt_deg * degrees_to_radians;
  const double a = beam.azimuth_deg * degrees_to_radians;
  if (beam.tilt_deg == 0) return {0, 0, -1};
  return normalized({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), -std::cos(t)});
}

void describe(ParameterVisitor& visit, Beam& beam) {
  visit(beam.energy_ev, {.name = "beam.energy",
                         .help = "Energy of the beam",
                         .unit = Unit::ev,
                         .limits = within(min_beam_energy_ev, max_beam_energy_ev)});
  visit(beam.tilt_deg, {.name = "beam.tilt",
                        .help = "Angle of the beam from straight down",
                        .unit = Unit::deg,
                        .limits = from_to_below(0, 90)});
  visit(beam.azimuth_deg,
        {.name = "beam.azimuth",
         .help = "Direction in which the tilted beam travels: 0 is +x, 90deg is +y",
         .unit = Unit::deg,
         .limits = within(-most_azimuth_deg, most_azimuth_deg),
         .level = Level::advanced});
  visit(beam.spot_nm, {.name = "beam.spot",
                       .help = "Standard deviation of the Gaussian spot; 0 is a point",
                       .unit = Unit::nm,
                       .limits = within(0, largest_length_nm)});
  visit(beam.convergence_deg,
        {.name = "beam.convergence",
         .help = "Half angle of the beam's cone, such as 5mrad; 0 is parallel",
         .unit = Unit::deg,
         .limits = within(0, most_convergence_deg),
         .level = Level::advanced});
  visit(beam.focus_nm,
        {.name = "beam.focus",
         .help = "Height of the cone's tip above the middle of the scan, along the beam",
         .unit = Unit::nm,
         .limits = within(-largest_length_nm, largest_length_nm),
         .level = Level::advanced});
  visit(beam.working_distance_nm,
        {.name = "beam.working_distance",
         .help = "Distance from the middle of the scan to the point that all beams come from, for "
                 "perspective; 0 is infinitely far",
         .unit = Unit::nm,
         .limits = within(0, largest_length_nm),
         .level = Level::advanced});
}

void describe(ParameterVisitor& visit, Scan& scan) {
  const Limits place = within(-largest_length_nm, largest_length_nm);
  visit(scan.width, {.name = "scan.width", .help = "Pixels along x", .limits = at_least(1)});
  visit(scan.height, {.name = "scan.height", .help = "Pixels along y", .limits = at_least(1)});
  visit(scan.pixel_x_nm,
        {.name = "scan.pixel_x", .help = "Width of a pixel", .unit = Unit::nm, .limits = above(0)});
  visit(
      scan.pixel_y_nm,
      {.name = "scan.pixel_y", .help = "Height of a pixel", .unit = Unit::nm, .limits = above(0)});
  visit(scan.center_x_nm, {.name = "scan.center_x",
                           .help = "Centre of the region, x",
                           .unit = Unit::nm,
                           .limits = place});
  visit(scan.center_y_nm, {.name = "scan.center_y",
                           .help = "Centre of the region, y",
                           .unit = Unit::nm,
                           .limits = place});
  visit(scan.center_z_nm, {.name = "scan.center_z",
                           .help = "Height of the scan plane's centre",
                           .unit = Unit::nm,
                           .limits = place});
}

void validate(const Beam& beam) { check_parameters(beam); }

void validate(const Scan& scan) {
  if (scan.width < 1 || scan.height < 1)
    throw UsageError("`scan.size`", "an image needs at least one pixel each way",
                     "Give a size such as 256x256");
  if (static_cast<std::int64_t>(scan.width) * scan.height > max_pixels)
    throw UsageError("`scan.size`",
                     fmt::format("{} x {} pixels are more than 2^28", scan.width, scan.height),
                     "Choose a smaller size or region");
  if (!(scan.pixel_x_nm > 0 && scan.pixel_y_nm > 0))
    throw UsageError("`scan.pixel_size`", "a pixel must be larger than nothing",
                     "Give a length such as 2nm");
  const double wide_nm = std::max(scan.width * scan.pixel_x_nm, scan.height * scan.pixel_y_nm);
  if (!(wide_nm <= widest_scan * largest_length_nm))
    throw UsageError("`scan.region`, `scan.pixel_size`",
                     fmt::format("the scan is {:.6g} nm wide, more than {:g} nm", wide_nm,
                                 widest_scan * largest_length_nm),
                     "Choose a smaller region or smaller pixels");
  for (const double center_nm : {scan.center_x_nm, scan.center_y_nm, scan.center_z_nm})
    if (!(std::abs(center_nm) <= largest_length_nm))
      throw UsageError("`scan.region`",
                       fmt::format("its centre is {:.6g} nm from 0, more than {:g} nm",
                                   std::abs(center_nm), largest_length_nm),
                       "Give four lengths X0,Y0,X1,Y1 nearer to 0");
}

}  // namespace surf::mc
