// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/beam.h"

#include <cmath>

#include <fmt/format.h>

#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/physics.h"

namespace surf::mc {

namespace {
constexpr double most_convergence_deg = 20;
}

Vec3 direction(const Beam& beam) {
  const double t = beam.tilt_deg * degrees_to_radians;
  const double a = beam.azimuth_deg * degrees_to_radians;
  if (beam.tilt_deg == 0) return {0, 0, -1};
  return normalized({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), -std::cos(t)});
}

void validate(const Beam& beam) {
  if (!(beam.energy_ev >= min_beam_energy_ev && beam.energy_ev <= max_beam_energy_ev))
    throw UsageError("--energy", fmt::format("{:g} eV is outside 100 eV to 30 keV", beam.energy_ev),
                     "Choose an energy in that range, such as 1keV");
  if (!(beam.tilt_deg >= 0 && beam.tilt_deg < 90))
    throw UsageError("--tilt", fmt::format("{:g} degrees is outside 0 to 90 (90 excluded)",
                                           beam.tilt_deg),
                     "Choose a smaller tilt and set its side with --azimuth");
  if (!std::isfinite(beam.azimuth_deg))
    throw UsageError("--azimuth", "it is not a finite number", "Give degrees, such as 90deg");
  if (!(beam.spot_nm >= 0 && std::isfinite(beam.spot_nm)))
    throw UsageError("--spot", "the spot's standard deviation must be 0 or more",
                     "Give a length, such as 1nm");
  if (!(beam.convergence_deg >= 0 && beam.convergence_deg <= most_convergence_deg))
    throw UsageError("--convergence", fmt::format("a half angle of {:g} degrees is outside 0 to {:g}",
                                                  beam.convergence_deg, most_convergence_deg),
                     "Microscopes have a few mrad: write 5mrad");
  if (!std::isfinite(beam.focus_nm))
    throw UsageError("--focus", "it is not finite", "Give a length, such as 0nm");
  if (!(beam.working_distance_nm >= 0 && std::isfinite(beam.working_distance_nm)))
    throw UsageError("--working-distance", "it must be above zero",
                     "Give a length, such as 5mm, or leave it out for parallel beams");
}

void validate(const Scan& scan) {
  if (scan.width < 1 || scan.height < 1)
    throw UsageError("--size", "an image needs at least one pixel each way",
                     "Give a size such as 256x256");
  if (static_cast<std::int64_t>(scan.width) * scan.height > max_pixels)
    throw UsageError("--size", fmt::format("{} x {} pixels are more than 2^28", scan.width,
                                           scan.height),
                     "Choose a smaller size or region");
  if (!(scan.pixel_x_nm > 0 && scan.pixel_y_nm > 0 && std::isfinite(scan.pixel_x_nm) &&
        std::isfinite(scan.pixel_y_nm)))
    throw UsageError("--pixel-size", "a pixel must be larger than nothing and finite",
                     "Give a length such as 2nm");
  if (!std::isfinite(scan.center_x_nm) || !std::isfinite(scan.center_y_nm) ||
      !std::isfinite(scan.center_z_nm))
    throw UsageError("--region", "its centre is not finite", "Give four lengths X0,Y0,X1,Y1");
}

}  // namespace surf::mc
