// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/beam.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/largest_length.h"
#include "surf/mc/physics.h"

namespace surf::mc {

namespace {
constexpr double most_convergence_deg = 20;
constexpr double most_azimuth_deg = 3600;     // ten turns: far beyond, numbers no longer tell directions apart
constexpr double widest_scan = 4;             // largest lengths: a tilted beam sees a box from corner to corner

// The error for a length from nothing (or minus the most) to the most.
[[noreturn]] void refuse_length(const char* option, double value_nm, const char* example, bool may_be_negative = false) {
  throw UsageError(option,
                   fmt::format("{:.6g} nm is not in {} to {:g} nm", value_nm,
                               may_be_negative ? fmt::format("-{:g}", largest_length_nm) : "0", largest_length_nm),
                   fmt::format("Give a length such as {}", example));
}
}  // namespace

Vec3 direction(const Beam& beam) {
  const double t = beam.tilt_deg * degrees_to_radians;
  const double a = beam.azimuth_deg * degrees_to_radians;
  if (beam.tilt_deg == 0) return {0, 0, -1};
  return normalized({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), -std::cos(t)});
}

void validate(const Beam& beam) {
  if (!(beam.energy_ev >= min_beam_energy_ev && beam.energy_ev <= max_beam_energy_ev))
    throw UsageError("`beam.energy`", fmt::format("{:g} eV is outside 100 eV to 30 keV", beam.energy_ev),
                     "Choose an energy in that range, such as 1keV");
  if (!(beam.tilt_deg >= 0 && beam.tilt_deg < 90))
    throw UsageError("`beam.tilt`", fmt::format("{:g} degrees is outside 0 to 90 (90 excluded)",
                                           beam.tilt_deg),
                     "Choose a smaller tilt and set its side with `beam.azimuth`");
  if (!(std::abs(beam.azimuth_deg) <= most_azimuth_deg))
    throw UsageError("`beam.azimuth`", fmt::format("{:g} degrees is outside -{:g} to {:g}", beam.azimuth_deg,
                                              most_azimuth_deg, most_azimuth_deg),
                     "Give an angle within a turn, such as 90deg");
  if (!(beam.spot_nm >= 0 && beam.spot_nm <= largest_length_nm)) refuse_length("`beam.spot`", beam.spot_nm, "1nm");
  if (!(beam.convergence_deg >= 0 && beam.convergence_deg <= most_convergence_deg))
    throw UsageError("`beam.convergence`", fmt::format("a half angle of {:g} degrees is outside 0 to {:g}",
                                                  beam.convergence_deg, most_convergence_deg),
                     "Microscopes have a few mrad: write 5mrad");
  if (!(std::abs(beam.focus_nm) <= largest_length_nm)) refuse_length("`beam.focus`", beam.focus_nm, "0nm", true);
  if (!(beam.working_distance_nm >= 0 && beam.working_distance_nm <= largest_length_nm))
    refuse_length("`beam.working_distance`", beam.working_distance_nm, "5mm, or leave it out for parallel beams");
}

void validate(const Scan& scan) {
  if (scan.width < 1 || scan.height < 1)
    throw UsageError("`scan.size`", "an image needs at least one pixel each way",
                     "Give a size such as 256x256");
  if (static_cast<std::int64_t>(scan.width) * scan.height > max_pixels)
    throw UsageError("`scan.size`", fmt::format("{} x {} pixels are more than 2^28", scan.width,
                                           scan.height),
                     "Choose a smaller size or region");
  if (!(scan.pixel_x_nm > 0 && scan.pixel_y_nm > 0))
    throw UsageError("`scan.pixel_size`", "a pixel must be larger than nothing", "Give a length such as 2nm");
  const double wide_nm = std::max(scan.width * scan.pixel_x_nm, scan.height * scan.pixel_y_nm);
  if (!(wide_nm <= widest_scan * largest_length_nm))
    throw UsageError("`scan.region`, `scan.pixel_size`",
                     fmt::format("the scan is {:.6g} nm wide, more than {:g} nm", wide_nm,
                                 widest_scan * largest_length_nm),
                     "Choose a smaller region or smaller pixels");
  for (const double center_nm : {scan.center_x_nm, scan.center_y_nm, scan.center_z_nm})
    if (!(std::abs(center_nm) <= largest_length_nm))
      throw UsageError("`scan.region`", fmt::format("its centre is {:.6g} nm from 0, more than {:g} nm", std::abs(center_nm),
                                               largest_length_nm),
                       "Give four lengths X0,Y0,X1,Y1 nearer to 0");
}

}  // namespace surf::mc
