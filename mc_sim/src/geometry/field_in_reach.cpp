// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/geometry/field_in_reach.h"

#include <algorithm>
#include <cmath>

#include "surf/mesh/height_field_mesh.h"

namespace surf::mc {

namespace {
constexpr double farthest_reach_nm = 1e6;
}

double reach_nm(const Medium& medium, const Beam& beam) {
  return std::min(medium.range_nm(beam.energy_ev + medium.barrier_ev()), farthest_reach_nm);
}

HeightField field_in_reach(const HeightFieldBody& body, const Scan& scan, double reach_nm) {
  const HeightField& f = body.field;
  require_no_holes(
      f);  // before the field is larger, so that it names the samples as they are given
  // The scan's corners, wherever a tilted beam may bring them, plus the electrons' reach.
  const double half = 0.5 * std::hypot(scan.width * scan.pixel_x_nm, scan.height * scan.pixel_y_nm);
  const auto margin = [&](double center, double lower, double upper) {
    return std::max({0.0, lower - (center - half - reach_nm), center + half + reach_nm - upper});
  };
  const double mx = margin(scan.center_x_nm, f.x_nm(0), f.x_nm(f.z_nm.width() - 1));
  const double my = margin(scan.center_y_nm, f.y_nm(0), f.y_nm(f.z_nm.height() - 1));
  return extend_height_field(f, mx, my, body.edge);
}

}  // namespace surf::mc
